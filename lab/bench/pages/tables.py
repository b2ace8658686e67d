"""Records of scripts/bench as tables in Markdown."""

import csv
import math


class Results:
    """The records of one task, the machine that they are from, and the commit."""

    def __init__(self, folder, task):
        lines = (folder / f"{task}.csv").read_text().splitlines()
        self.machine, self.commit = (line.removeprefix("# ") for line in lines[:2])
        self.records = list(csv.DictReader(line for line in lines if not line.startswith("#")))

    def where(self, **wanted):
        return [r for r in self.records if all(r[column] == value for column, value in wanted.items())]

    def distinct(self, column, **wanted):
        return list(dict.fromkeys(r[column] for r in self.where(**wanted)))


def number(text, scale=1.0):
    """Three digits, as a reader compares them; two of what is written in powers of ten."""
    if text in ("", None):
        return ""
    value = scale * float(text)
    if value == 0 or math.isnan(value):
        return "0" if value == 0 else ""
    if abs(value) < 0.001:
        return f"{value:.1e}"
    digits = max(0, 2 - math.floor(math.log10(abs(value))))
    return f"{value:.{digits}f}"


def percent(share):
    """Three digits, however small: per cent are never written in powers of ten."""
    value = 100 * float(share)
    if value == 0:
        return "0"
    text = f"{value:.{max(0, 2 - math.floor(math.log10(value)))}f}"
    return text.rstrip("0") if value < 0.01 else text


def in_one_notation(texts, scale):
    """Numbers that are compared: all in powers of ten where one of them is too small for three decimals."""
    if not any(0 < scale * float(text) < 0.001 for text in texts if text):
        return [number(text, scale) for text in texts]
    return [f"{scale * float(text):.1e}" if text and float(text) else text for text in texts]


def table(rows):
    head, *body = [[str(cell) for cell in row] for row in rows]
    lines = [head, ["---"] + ["--:"] * (len(head) - 1)] + body
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def label(record):
    return f"**{record['system']}**" if record["role"] == "ours" else record["system"]


def per_set(results, column, form=number, **wanted):
    """The cells U, S and C of a column."""
    return [form(r[column]) if r else "" for r in (next(iter(results.where(set=s, **wanted)), None) for s in "USC")]
