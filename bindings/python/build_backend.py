"""Called by pip and `build` to make a wheel or a source distribution (PEP 517): CMake compiles, this packs.

The setting ``build-dir`` names a build folder that is already configured with ECHINUS_BUILD_PYTHON=ON; without it
the module is built in build/python.
"""

import base64
import gzip
import hashlib
import io
import pathlib
import re
import subprocess
import sys
import sysconfig
import tarfile
import tempfile
import tomllib
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SOURCES = ["CMakeLists.txt", "LICENSE", "README.md", "adapters/bullet", "bindings/python", "cmake", "include", "pyproject.toml", "src"]
PARTS_NOT_NEEDED = ["C", "RENDER", "TOOLS", "TESTS", "EXAMPLES"]


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    build = (config_settings or {}).get("build-dir") or configured(ROOT / "build" / "python")
    subprocess.run(["cmake", "--build", build, "--target", "echinus_python"], check=True)
    version = sysconfig.get_config_var("py_version_nodot")
    tag = f"cp{version}-cp{version}-" + re.sub("[-.]", "_", sysconfig.get_platform())
    wheel_text = f"Wheel-Version: 1.0\nGenerator: echinus\nRoot-Is-Purelib: false\nTag: {tag}\n"
    info = f"echinus-{library_version()}.dist-info"
    with tempfile.TemporaryDirectory() as staging:
        install = ["cmake", "--install", build, "--component", "python", "--strip", "--prefix", staging]
        subprocess.run(install, check=True, stdout=subprocess.DEVNULL)
        files = {name: path.read_bytes() for name, path in files_below(pathlib.Path(staging))}
    files |= {f"{info}/METADATA": metadata().encode(), f"{info}/WHEEL": wheel_text.encode()}
    files |= {f"{info}/LICENSE": (ROOT / "LICENSE").read_bytes()}
    records = [f"{name},sha256={digest(content)},{len(content)}\n" for name, content in files.items()]
    files[f"{info}/RECORD"] = "".join([*records, f"{info}/RECORD,,\n"]).encode()
    wheel = f"echinus-{library_version()}-{tag}.whl"
    with zipfile.ZipFile(pathlib.Path(wheel_directory, wheel), "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            entry = zipfile.ZipInfo(name)  # of 1980: the same content gives the same bytes
            entry.external_attr = 0o644 << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, content)
    return wheel


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    """Without it pip builds the wheel to read its metadata, for minutes and under that heading."""
    info = pathlib.Path(metadata_directory, f"echinus-{library_version()}.dist-info")
    info.mkdir()
    (info / "METADATA").write_text(metadata())
    return info.name


def build_sdist(sdist_directory, config_settings=None):
    name = f"echinus-{library_version()}"
    packed = io.BytesIO()
    with tarfile.open(fileobj=packed, mode="w", format=tarfile.PAX_FORMAT) as archive:
        add(archive, f"{name}/PKG-INFO", metadata().encode())
        for source in SOURCES:
            path = ROOT / source
            for file in [path] if path.is_file() else [path / name for name, _ in files_below(path)]:
                add(archive, f"{name}/{file.relative_to(ROOT)}", file.read_bytes())
    with open(pathlib.Path(sdist_directory, f"{name}.tar.gz"), "wb") as file:
        file.write(gzip.compress(packed.getvalue(), mtime=0))
    return f"{name}.tar.gz"


def configured(build):
    switches = [f"-DECHINUS_BUILD_{part}=OFF" for part in PARTS_NOT_NEEDED]
    subprocess.run(
        ["cmake", "-S", ROOT, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DECHINUS_BUILD_PYTHON=ON",
         f"-DPython_EXECUTABLE={sys.executable}", *switches, "--log-level=WARNING"],
        check=True,
    )
    return build


def library_version():
    header = (ROOT / "include" / "echinus" / "version.h").read_text()
    return re.search(r'ECHINUS_VERSION_STRING "(.*)"', header)[1]


def metadata():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    needs = "".join(f"Requires-Dist: {package}\n" for package in project["dependencies"])
    return (
        f"Metadata-Version: 2.1\nName: echinus\nVersion: {library_version()}\nSummary: {project['description']}\n"
        f"License: MIT\nRequires-Python: {project['requires-python']}\n{needs}"
        "Description-Content-Type: text/markdown\n\n" + (ROOT / "README.md").read_text()
    )


def files_below(folder):
    """(name relative to the folder, path), in order of names."""
    for path in sorted(folder.rglob("*")):
        if path.is_file() and "__pycache__" not in path.parts:
            yield str(path.relative_to(folder)), path


def add(archive, name, content):
    entry = tarfile.TarInfo(name)
    entry.size = len(content)
    archive.addfile(entry, io.BytesIO(content))


def digest(content):
    return base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
