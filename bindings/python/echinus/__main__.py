"""python3 -m echinus: what the package does from a shell."""

import io
import sys

if __name__ == "__main__":
    try:
        from echinus.corpus._command import main, parse

        for stream in (sys.stdout, sys.stderr):
            if isinstance(stream, io.TextIOWrapper):  # names of files may be no text
                stream.reconfigure(errors="backslashreplace")
        sys.exit(main(parse()))
    except KeyboardInterrupt:  # while modules are imported; later main() hears it
        sys.exit(130)
