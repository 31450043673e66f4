"""Feeds spoilt files to the readers and reports whatever they do beyond their promise.

    python tests/fuzz/harness.py                     20 000 mutations of images and every truncation (promise.py)
    python tests/fuzz/harness.py --doors             20 000 mutations for every other door (doors.py)
    python tests/fuzz/harness.py [--doors] --forever           without end, with a line of progress every 20 000
    python tests/fuzz/harness.py [--doors] --seed 7 --case 41  saves one mutation as a file, and checks it in this process

Inputs that break the promise are made as small as they still do so, and saved in tests/fuzz/found, where test_fuzz.py and
test_doors.py check them ever after.

They are read in a child process: one that dies, or does not come back, is reported with the input it was at, and the
next goes on behind it. An input is a function of the seed and its number, so both sides know it.
"""

from __future__ import annotations

import argparse
import multiprocessing
import re
import signal
import sys
import time
from collections import Counter
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, NamedTuple

sys.path.insert(0, str(Path(__file__).parents[1]))  # as pytest does; seeds are made by helpers of other rooms' tests

from inputs import COUNT, DoorMutations, Inputs, Mutations, Truncations, verdict
from minimise import minimised

FOUND = Path(__file__).parent / "found"
_AT_ONCE = 1000
_OF_A_KIND = 3
_NO_SIGN_OF_LIFE_SECONDS = 60.0  # of the wall clock, and so only for what never comes back
_NO_START_SECONDS = 600.0  # the same, until the child is at its first input


class Broken(NamedTuple):
    """An input that broke the promise."""

    number: int
    name: str
    why: str


@dataclass
class Findings:
    accepted: Counter[str] = field(default_factory=Counter)
    refused: Counter[str] = field(default_factory=Counter)
    broken: list[Broken] = field(default_factory=list)

    @property
    def count(self) -> int:
        return self.accepted.total() + self.refused.total() + len(self.broken)


def examine(inputs: Inputs, first: int = 0, most_broken: int = 10) -> Findings:
    """Checks the inputs from number `first` on in child processes; stops early after `most_broken` of them."""
    findings = Findings()
    while first < len(inputs) and len(findings.broken) < most_broken:
        first = _examine_until_death(inputs, first, findings)
    return findings


def _examine_until_death(inputs: Inputs, first: int, findings: Findings) -> int:
    """The number of the next input: behind the one that killed the child, or behind the last."""
    spawn = multiprocessing.get_context("spawn")
    at, begun = spawn.RawValue("q", first), spawn.RawValue("b", 0)
    receiver, sender = spawn.Pipe(duplex=False)
    child = spawn.Process(target=_work, args=(inputs, first, at, begun, sender), daemon=True)
    child.start()
    sender.close()
    seen, since = (first, 0), time.monotonic()
    why = ""
    try:
        while not why:
            if not receiver.poll(1.0):
                patience = _NO_SIGN_OF_LIFE_SECONDS if begun.value else _NO_START_SECONDS
                if (at.value, begun.value) != seen:
                    seen, since = (at.value, begun.value), time.monotonic()
                elif time.monotonic() - since > patience:
                    why = f"did not come back within {patience:.0f} s"
                continue
            message = receiver.recv()
            if message is None:
                return len(inputs)
            for name, accepted in message[0]:
                (findings.accepted if accepted else findings.refused)[name] += 1
            findings.broken += message[1]
    except EOFError:
        child.join()
        why = f"killed its process (exit code {child.exitcode})"
    finally:
        child.kill()
        child.join()
    findings.broken.append(Broken(at.value, inputs[at.value][0], why))
    return int(at.value) + 1


def _work(inputs: Inputs, first: int, at: Any, begun: Any, sender: Connection) -> None:
    """The child: sends what it found every now and then, and None when it is through."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl+C is for the parent, which ends its child
    witness = inputs.judge()
    begun.value = 1
    for begin in range(first, len(inputs), _AT_ONCE):
        outcomes, broken = [], []
        for number in range(begin, min(begin + _AT_ONCE, len(inputs))):
            at.value = number
            name, data = inputs[number]
            outcome = verdict(witness, name, data)
            if isinstance(outcome, str):
                broken.append(Broken(number, name, outcome))
            else:
                outcomes.append((name, outcome))
        sender.send((outcomes, broken))
    sender.send(None)


def save(data: bytes, stem: str, name: str, folder: Path = FOUND) -> Path:
    """Writes an input; `name` is its seed's, for a door but that of images with a folder."""
    path = folder / Path(name).with_name(f"{stem}-{Path(name).name}")
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(data)
    return path


def report(inputs: Inputs, stem: str, findings: Findings, reported: Counter[str]) -> None:
    """Prints what broke the promise and saves it, the first few of a kind; `reported` counts the kinds."""
    for number, name, why in findings.broken:
        kind = Path(name).suffix + kind_of(why)
        reported[kind] += 1
        if reported[kind] > _OF_A_KIND:
            continue
        path = save(_small(inputs, number, why), f"{stem}-{number}", name)
        print(f"BROKEN: number {number} of seed {stem}, of {name}: {why}; saved as {path}", flush=True)


def _small(inputs: Inputs, number: int, why: str) -> bytes:
    """An input made small; one that takes its process with it, or for ever, stays as it is."""
    name, data = inputs[number]
    if why.startswith(("killed", "did not come back")):
        return data
    judge = inputs.judge()
    return minimised(data, lambda part: kind_of(verdict(judge, name, part)) == kind_of(why))


def kind_of(why: bool | str) -> str:
    """What went wrong, without figures and what is quoted."""
    return re.sub(r"\d+|'.*'|\".*\"|: .*", "", str(why))


def _print_table(findings: Findings) -> None:
    for name in sorted(findings.accepted.keys() | findings.refused.keys()):
        accepted, refused = findings.accepted[name], findings.refused[name]
        share = accepted / max(1, accepted + refused)
        print(f"{name:30} {accepted + refused:6} inputs, {share:6.1%} accepted, {1 - share:6.1%} refused")


def _one(seed: int, number: int, kind: type[Mutations | DoorMutations], folder: Path) -> int:
    inputs = kind(seed)
    name, data = inputs[number]
    print(
        f"number {number} of seed {seed}, of {name}, saved as {save(data, f'{seed}-{number}', name, folder)}",
        flush=True,
    )
    print({True: "accepted", False: "refused"}.get(outcome := verdict(inputs.judge(), name, data), outcome))
    return isinstance(outcome, str)


def _forever(seed: int, kind: type[Mutations | DoorMutations]) -> int:
    began, inputs, number, reported = time.monotonic(), kind(seed, sys.maxsize), 0, Counter[str]()
    while True:
        part = kind(seed, number + 20 * _AT_ONCE)
        findings = examine(part, number, most_broken=sys.maxsize)
        report(inputs, str(seed), findings, reported)
        number = len(part)
        rate = number / (time.monotonic() - began)
        print(
            f"{number} inputs of seed {seed}, {rate:.0f} a second, {findings.accepted.total() / findings.count:.0%} of"
            f" the last {findings.count} accepted, {reported.total()} broke the promise",
            flush=True,
        )


def _once(seed: int, count: int, doors: bool) -> int:
    reported = Counter[str]()
    images: dict[str, Inputs] = {str(seed): Mutations(seed, count), "truncated": Truncations()}
    for stem, inputs in ({str(seed): DoorMutations(seed, count)} if doors else images).items():
        began = time.monotonic()
        findings = examine(inputs, most_broken=sys.maxsize)
        report(inputs, stem, findings, reported)
        _print_table(findings)
        print(f"{stem}: {findings.count} inputs in {time.monotonic() - began:.1f} s, {len(findings.broken)} broken")
    return reported.total() > 0


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=0, help="another number, other mutations")
    parser.add_argument("--count", type=int, default=COUNT)
    parser.add_argument("--forever", action="store_true")
    parser.add_argument("--doors", action="store_true", help="all that is no image")
    parser.add_argument("--into", type=Path, default=FOUND, help="the folder for the file of --case")
    parser.add_argument("--case", type=int, help="the number of one mutation")
    options = parser.parse_args()
    kind = DoorMutations if options.doors else Mutations
    if options.case is not None:
        return _one(options.seed, options.case, kind, options.into)
    return _forever(options.seed, kind) if options.forever else _once(options.seed, options.count, options.doors)


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(130)
