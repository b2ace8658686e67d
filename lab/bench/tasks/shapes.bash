#!/usr/bin/env bash
# Checks maps of shapes that designers make by brute force, by the million, and writes lab/bench/results/shapes.csv and the
# table of docs/accuracy.md. Some two hours on two cores. Started again on the same commit it goes on where it was stopped.
#
#   scripts/bench shapes           10^6 shapes for sides and map files, 10^5 for all other queries, 10^4 for tetrahedra
#   scripts/bench shapes --short   a hundredth of them, into out/bench
#
# Fails when an answer is wrong; out/shapes/ then names the seeds, and echinus-shapes --checks CHECKS --show SEED a
# smaller shape with the same fault.
set -euo pipefail
cd "$(dirname "$0")/../../.."
portion=10000 # seeds of one process: less than an hour
share=1 results=lab/bench/results out=out/shapes page=docs/accuracy.md
program=build/bench/lab/bench/echinus-shapes

while [ $# -gt 0 ]; do
    case "$1" in
    --short) share=100 portion=1000 results=out/bench out=out/shapes/short page=; shift ;;
    *)
        echo "shapes: unknown option '$1'; usage: scripts/bench shapes [--short]" >&2
        exit 2
        ;;
    esac
done

cmake --preset bench --log-level=WARNING
cmake --build --preset bench --target echinus-shapes --parallel "$(nproc)"
commit=$(git rev-parse --short HEAD)
out=$out/$commit
mkdir -p "$out" "$results"

ranges() { # CHECKS COUNT: one line a process
    local first
    for ((first = 1; first <= $2 / share; first += portion)); do
        echo "$1 $first $(($2 / share - first + 1 < portion ? $2 / share - first + 1 : portion))"
    done
}

check() { # CHECKS FIRST COUNT
    "$program" --checks "$1" --first "$2" --count "$3" --commit "commit $commit" --report "$out/$1-$2.csv" >>"$out/failures.txt"
}
export -f check
export program out commit

status=0
{ ranges sides 1000000 && ranges queries 100000 && ranges tetrahedra 10000; } |
    xargs -P "$(nproc)" -L 1 bash -c 'check "$@"' check || status=1
"$program" --merge "$out"/*.csv --report "$results/shapes.csv"

rows() {
    awk -F, '!/^#/ && $1 != "checks" {
        printf "| %s | %s | %s | %s | %s | %s | %s | %s | %s |\n", $1, $3, $4, $5, $8, $6, $7, $10 == 0 ? "" : $10 * 1e6, $11 == 0 ? "" : $11 * 100
    }' "$results/shapes.csv"
}

write_table() {
    echo
    sed -n 's/^# //p' "$results/shapes.csv" | paste -sd ';' | sed 's/;/; /g; s/$/./'
    echo
    echo "| checks | shapes | faces | left out | answers | wrong shapes | unreadable | distance, 1e-6 R | volume, % |"
    echo "|---|---|---|---|---|---|---|---|---|"
    rows
    echo
}

if [ -n "$page" ]; then
    table=$out/table.md
    write_table >"$table"
    sed -i -e "/^<!-- shapes/,/^<!-- end of shapes/{/^<!-- shapes/{p;r $table" -e "};/^<!-- end of shapes/p;d}" "$page"
fi
printf '\nDone in %d s. See %s\n' "$SECONDS" "$results/shapes.csv"
exit $status
