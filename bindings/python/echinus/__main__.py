"""The command line of the package: python3 -m echinus."""

import io
import sys

if __name__ == "__main__":
    try:
        from echinus.corpus._command import main, parse

        for stream in (sys.stdout, sys.stderr):
            if isinstance(stream, io.TextIOWrapper):  # file names may not be valid text
                stream.reconfigure(errors="backslashreplace")
        sys.exit(main(parse()))
    except KeyboardInterrupt:  # while modules are imported; afterwards main() handles it
        sys.exit(130)
