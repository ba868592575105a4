#!/usr/bin/env python3
"""Symbolic execution of the compiled harnesses.

    run.py               all harnesses
    run.py NAME...       these
    run.py --planted     in a copy of the sources with a fault for each harness: each must be found
    run.py --list        prints the names

Exit code 0: each holds, or each fault was found. 1: one does not hold, or a fault was not found. 2: angr is
missing, or bad usage. 3: there is no verdict, because a bound was reached.
"""

import argparse
import os
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")).resolve() / "symbolic"
# What a copy needs to compile the harnesses; of the root package, only what its manifest names.
CRATES = ["logs", "model", "proofs", "vision"]
ROOT_FILES = ["Cargo.toml", "src/*.rs", "tests/*.rs", "fuzz/corpus/colours/*"]
HOLDS, VIOLATED, UNKNOWN = 0, 1, 3
OUTCOMES = {0: "holds", 1: "excluded", 2: "a value", 3: "an error"}


def build(root, name):
    """Compiles the harnesses of a checkout, and returns the program, under this name."""
    manifest = root / "proofs/symbolic/harness/Cargo.toml"
    command = ["cargo", "build", "--release", "--locked", "--quiet", "--manifest-path", manifest]
    subprocess.run([*command, "--target-dir", TARGET], check=True)
    return shutil.copy2(TARGET / "release/toposlam-symbolic", TARGET / name)


def harnesses(program):
    """The name, the input and the expected outcomes of each harness."""
    lines = subprocess.run([program], check=True, capture_output=True, text=True).stdout.splitlines()
    rows = (line.split("\t") for line in lines)
    return [(name, given, [int(one) for one in covers[1:-1].split(",")]) for name, given, covers in rows]


def replay(program, name, given):
    """What the program prints when it panics on the input; `None` if it does not panic."""
    words = [str(byte) for byte in given]
    environment = {**os.environ, "RUST_BACKTRACE": "0"}
    run = subprocess.run([program, name, *words], capture_output=True, text=True, env=environment)
    lines = [line for line in run.stderr.splitlines() if line and not line.startswith("note: ")]
    return "\n".join(lines) if run.returncode < 0 and "panicked at" in run.stderr else None


def judge(result, covers):
    """The verdict on a harness, and why."""
    if result.failing is not None:
        return VIOLATED, f"violated: input bytes {' '.join(map(str, result.failing))}"
    if result.unknown is not None:
        return UNKNOWN, f"not known: {result.unknown}"
    missing = [OUTCOMES[one] for one in covers if one not in result.paths]
    if missing:
        return VIOLATED, f"violated: no input reaches the outcome {', '.join(missing)}"
    return HOLDS, "holds"


def in_words(paths):
    """The number of paths of each outcome."""
    return ", ".join(f"{OUTCOMES[outcome]} {number}" for outcome, number in sorted(paths.items()))


def check(program, names, seconds):
    """Explores harnesses, and yields each with its verdict and with what a run of its input prints."""
    from engine import Engine

    engine = Engine(program)
    for number, (name, _, covers) in enumerate(harnesses(program)):
        if names and name not in names:
            continue
        result = engine.explore(number, seconds)
        verdict, why = judge(result, covers)
        paths = in_words(result.paths)
        print(f"{name}: {result.count} paths ({paths}), {result.seconds:.0f} s: {why}", flush=True)
        panic = None
        if result.failing is not None:
            panic = replay(program, name, result.failing)
            if panic is None:
                verdict, panic = UNKNOWN, "a run on these bytes does not panic, so the engine is wrong"
            print("  " + panic.replace("\n", "\n  "), flush=True)
        yield name, verdict, panic


def plant(copy, faults):
    """Makes a copy of the sources with these faults. A file that stays the same keeps its time, for cargo."""
    changed = {ROOT / fault["file"]: (ROOT / fault["file"]).read_text() for fault in faults}
    for fault in faults:
        text = changed[ROOT / fault["file"]]
        if text.count(fault["old"]) != 1:
            raise SystemExit(f"{fault['file']} does not contain this once: {fault['old']}")
        changed[ROOT / fault["file"]] = text.replace(fault["old"], fault["new"])
    sources = [*ROOT_FILES, *(f"{crate}/**/*" for crate in CRATES)]
    for file in (file for source in sources for file in ROOT.glob(source) if file.is_file()):
        content = changed[file].encode() if file in changed else file.read_bytes()
        to = copy / file.relative_to(ROOT)
        if not to.is_file() or to.read_bytes() != content:
            to.parent.mkdir(parents=True, exist_ok=True)
            to.write_bytes(content)


def planted(names, seconds):
    """Whether the fault of each harness is found."""
    import tomllib  # since Python 3.11

    faults = tomllib.loads((HERE / "faults.toml").read_text())
    names = names or [name for name, _, _ in harnesses(build(ROOT, "sound"))]
    found = set()
    for copy in sorted({fault["round"] for fault in faults.values()}):
        ours = {name: fault for name, fault in faults.items() if fault["round"] == copy and name in names}
        if ours:
            plant(TARGET / f"copy-{copy}", ours.values())
            program = build(TARGET / f"copy-{copy}", f"planted-{copy}")
            for name, verdict, panic in check(program, ours.keys(), seconds):
                if verdict == VIOLATED and panic is not None and ours[name]["panic"] in panic:
                    found.add(name)
    lost = [name for name in names if name not in found]
    print(f"{len(found)} of {len(names)} faults found", *(f"not found: {name}" for name in lost), sep="\n")
    return VIOLATED if lost else HOLDS


def main():
    parser = argparse.ArgumentParser(description="Symbolic execution of the compiled harnesses.")
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--list", action="store_true", help="print the names")
    parser.add_argument("--planted", action="store_true", help="in a copy with a fault for each harness")
    parser.add_argument("--seconds", type=float, default=600, help="of processor time, for each harness")
    arguments = parser.parse_args()
    try:
        import engine  # noqa: F401
    except ImportError as error:
        requirements = HERE / "requirements.txt"
        print(f"This needs angr: pip install -r {requirements} ({error})", file=sys.stderr)
        return 2
    if arguments.planted:
        return planted(arguments.names, arguments.seconds)
    program = build(ROOT, "sound")
    known = [name for name, _, _ in harnesses(program)]
    if arguments.list:
        print("\n".join(known))
        return 0
    unknown = [name for name in arguments.names if name not in known]
    if unknown:
        print(f"There is no harness {', '.join(unknown)}.", file=sys.stderr)
        return 2
    verdicts = [verdict for _, verdict, _ in check(program, arguments.names, arguments.seconds)]
    return VIOLATED if VIOLATED in verdicts else max(verdicts)


if __name__ == "__main__":
    sys.exit(main())
