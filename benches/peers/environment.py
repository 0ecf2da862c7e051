"""What the races run in: a virtual environment of their own, LLVM for Mitsuba, the malus of this repository."""

import glob
import os
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parent.parent
WORK = REPOSITORY / "target" / "peers"
VENV = WORK / "venv"
# The variable names another program to race, such as an older one.
MALUS = Path(os.environ.get("MALUS", REPOSITORY / "target" / "release" / "malus")).resolve()

# Mitsuba's kernels need an instruction that LLVM 15 cannot select: "fmaximum".
OLDEST_LLVM = 16


def enter():
    """Goes on inside the virtual environment, which is made at the first call."""
    if Path(sys.prefix).resolve() == VENV.resolve():
        return
    python = VENV / "bin" / "python"
    stamp = VENV / "requirements.txt"
    wanted = (HERE / "requirements.txt").read_text()
    if not stamp.exists() or stamp.read_text() != wanted:
        subprocess.run([sys.executable, "-m", "venv", "--clear", VENV], check=True)
        pip = [python, "-m", "pip", "install", "--quiet", "-r", HERE / "requirements.txt"]
        subprocess.run(pip, check=True)
        stamp.write_text(wanted)
    os.execv(python, [python, *sys.argv])


def build_malus():
    """The program, as its users build it, unless another one is named."""
    if "MALUS" in os.environ:
        return
    subprocess.run(["cargo", "build", "--release", "--locked"], cwd=REPOSITORY, check=True)


def llvm():
    """The newest LLVM library installed.

    Raises SystemExit that names the Debian package where there is none.
    """
    found = {}
    for path in glob.glob("/usr/lib/*/libLLVM*.so*") + glob.glob("/usr/lib/llvm-*/lib/libLLVM*.so*"):
        digits = "".join(c if c.isdigit() else " " for c in Path(path).name).split()
        if digits and int(digits[0]) >= OLDEST_LLVM:
            found[int(digits[0])] = path
    if not found:
        sys.exit(
            f"error: Mitsuba needs LLVM {OLDEST_LLVM} or later, and none is in /usr/lib: "
            "apt-get install libllvm19"
        )
    return found[max(found)]
