"""Memory: what a file takes is known before it is taken, and the only way in is the reader that bounds it."""

from __future__ import annotations

import ctypes
import io
import json
import os
import platform
import re
import struct
import subprocess
import sys
import zlib
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from threading import Event
from typing import Any

import numpy as np
import pytest
from helpers import frame_of, picture_of
from lights.images.hdr_files import raw_exr_header
from PIL import Image
from places import ENVIRONMENT

from shviewer import memory
from shviewer.analysis.subjects import MEMORY
from shviewer.cli import project as project_mode
from shviewer.cli.main import main
from shviewer.errors import LightError
from shviewer.files import read_bytes
from shviewer.lights.find import find_light
from shviewer.lights.images import isolated as isolated_module
from shviewer.lights.images import openexr, openexr_headers, radiance_files
from shviewer.lights.images.openexr import decode_openexr
from shviewer.lights.images.radiance_files import read_radiance_image
from shviewer.lights.reading import Reading
from shviewer.limits import TEXEL_BYTES, Limits
from shviewer.viewer.desktop.session import Session
from shviewer.viewer.saving.reference import compare_with_reference
from shviewer.viewer.saving.stamp import metadata
from shviewer.viewer.saving.stamp_reading import state_of_stamp
from shviewer.viewer.state import state_of

POSIX = pytest.mark.skipif(os.name != "posix", reason="pipes and limits as POSIX has them")
LINUX = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="RLIMIT_AS and /proc are Linux's")
GIB = 2**30


# --- files whose size only their headers tell


def hdr_of_runs(width: int, height: int) -> bytes:
    """A flat .hdr in the old packing, 12 bytes a scanline."""
    row, left = bytes((128, 128, 128, 129)), width - 1
    while left:
        row += bytes((1, 1, 1, left & 255))
        left >>= 8
    return b"#?RADIANCE\n\n-Y %d +X %d\n" % (height, width) + row * height


def flat_png(width: int, height: int, bits: int = 8, colour_type: int = 0) -> bytes:
    row = b"\0" + b"\x7f" * (width * {0: 1, 2: 3, 6: 4}[colour_type] * bits // 8)
    packer = zlib.compressobj(1)
    packed = b"".join(packer.compress(row) for _ in range(height)) + packer.flush()

    def chunk(kind: bytes, content: bytes) -> bytes:
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))

    header = struct.pack(">IIBBBBB", width, height, bits, colour_type, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", packed) + chunk(b"IEND", b"")


def flat_exr(width: int, height: int, channels: str = "BGR", kind: int = 1, more: Any = None) -> bytes:
    """A black ZIP file whose chunks, of 16 rows, are all alike. kind: 1 for half, 2 for float. more: other attributes."""
    window = (0, 0, width - 1, height - 1)
    head = raw_exr_header([(name, 1) for name in channels], window, compression=3, kind=kind, more=more)
    differences = bytearray(b"\x80" * (16 * width * len(channels) * 2 * kind))
    differences[0] = 0
    packed = zlib.compress(bytes(differences))
    start = len(head) + 8 * (height // 16)
    size = 8 + len(packed)
    offsets = b"".join(struct.pack("<Q", start + i * size) for i in range(height // 16))
    return head + offsets + b"".join(struct.pack("<iI", 16 * i, len(packed)) + packed for i in range(height // 16))


def in_a_process(code: str, *arguments: str, address_space: int = 0) -> subprocess.CompletedProcess[str]:
    """Run code with `main` in a process of its own. address_space: its RLIMIT_AS, bytes."""
    bound = (
        f"import resource; resource.setrlimit(resource.RLIMIT_AS, ({address_space},) * 2)\n" if address_space else ""
    )
    command = [sys.executable, "-c", f"{bound}import sys\nfrom shviewer.cli.main import main\n{code}", *arguments]
    return subprocess.run(command, env=ENVIRONMENT, capture_output=True, text=True)


PEAK = """
def peak():
    return int(open("/proc/self/status").read().split("VmHWM:")[1].split()[0]) * 1024
"""


@LINUX
def test_a_small_file_that_would_fill_the_memory_is_one_line_and_takes_none(tmp_path: Path) -> None:
    """Each of these took 4 GB, inside all limits of size: 26 bytes a texel, or the 28 of its decoder."""
    bombs = {
        "old.hdr": hdr_of_runs(32768, 4096),
        "zip.exr": flat_exr(32768, 4096),
        "flat.png": flat_png(32768, 4096),
        "float.exr": flat_exr(32768, 4096, "ABGR", 2),
    }
    for name, data in bombs.items():
        (tmp_path / name).write_bytes(data)
    paths = [str(tmp_path / name) for name in bombs]
    done = in_a_process(PEAK + "print(main(['info', *sys.argv[1:]]), peak())", *paths, address_space=2 * GIB)
    code, peak = map(int, done.stdout.split())
    lines = done.stderr.splitlines()
    assert code == LightError.exit_code
    assert len(lines) == len(bombs)
    for line, path in zip(lines, paths, strict=True):
        assert line.startswith(f"shviewer: {path}: ")
        taken = re.search(r"32768 x 4096 texels takes up to (\d+) MiB", line)
        assert taken is not None
        assert 3328 <= int(taken[1]) < 3700
        assert "half of what is available" in line
        assert "--max-memory-mib" in line
    assert peak < 2**28


@LINUX
def test_a_texel_takes_no_more_than_is_said_of_it_in_any_format(tmp_path: Path) -> None:
    """Beside 48 MiB for libraries and tables: an honest flat map opens within its figure."""
    shape = 4096, 2048
    jpeg = io.BytesIO()
    Image.new("RGB", shape, (90, 120, 200)).save(jpeg, "JPEG", progressive=True, subsampling=0)
    files = {
        "old.hdr": hdr_of_runs(*shape),
        "float.exr": flat_exr(*shape, "ABGR", 2),
        "deep.png": flat_png(*shape, 16, 6),
        "progressive.jpg": jpeg.getvalue(),
    }
    for name, data in files.items():
        (tmp_path / name).write_bytes(data)
    code = PEAK + (
        "from shviewer.lights.find import find_light\n"
        "from shviewer.lights.reading import Reading\n"
        "for path in [sys.argv[1], *sys.argv[1:]]:\n"
        "    open('/proc/self/clear_refs', 'w').write('5')\n"
        "    start = peak()\n"
        "    light = find_light(path, Reading(isolated=False))\n"
        "    light.coefficients(5), light.products(), light.landmarks(), light.map\n"
        "    del light\n"
        "    print(peak() - start)\n"
    )
    done = in_a_process(code, *(str(tmp_path / name) for name in files))
    assert done.returncode == 0, done.stderr
    _, *grown = map(int, done.stdout.split())  # the first has loaded the libraries
    for name, taken in zip(files, grown, strict=True):
        assert taken < TEXEL_BYTES * shape[0] * shape[1] + 48 * 2**20, name


@LINUX
def test_an_honest_flat_map_of_8192_columns_opens_in_2_gib_of_memory(tmp_path: Path) -> None:
    """Half of 4 GiB of address space, which libraries take from, too."""
    path = tmp_path / "flat.exr"
    path.write_bytes(flat_exr(8192, 4096))
    assert path.stat().st_size < 214_000
    out = tmp_path / "flat.json"
    done = in_a_process("main(sys.argv[1:])", "project", str(path), "-o", str(out), address_space=4 * GIB)
    assert out.exists(), done.stderr


@POSIX
def test_the_figure_is_changed_by_a_flag(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "a.hdr"
    path.write_bytes(hdr_of_runs(512, 256))
    MEMORY.clear()
    assert main(["info", str(path), "--max-memory-mib", "3.2"]) == LightError.exit_code
    assert "image of 512 x 256 texels takes up to 3 MiB of memory; the limit is 3 MiB: " in capsys.readouterr().err
    assert main(["info", str(path), "--max-memory-mib", "4"]) == 0


def test_rasters_and_suns_are_within_the_figure_too(tmp_path: Path) -> None:
    path = tmp_path / "cross.hdr"
    path.write_bytes(hdr_of_runs(384, 512))
    limits = Limits(memory_bytes=TEXEL_BYTES * 384 * 512)
    light = find_light(str(path), Reading(layout="cube", limits=limits))
    assert light.map is not None  # RASTER_BYTES * 512 * 256 are fewer
    tight = replace(light, limits=Limits(memory_bytes=2**20))
    with pytest.raises(LightError, match=r"^cross: taking suns out of 384 x 512 texels takes up to 5 MiB"):
        tight.split_suns()
    with pytest.raises(LightError, match=r"^cross: a raster of 512 x 256 texels takes up to 3 MiB"):
        _ = tight.map


# --- what the systems say


def tree(root: Path, files: dict[str, str]) -> Path:
    for name, text in {"proc/self/cgroup": "", "proc/self/mountinfo": "", **files}.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return root


MEMINFO = {"proc/meminfo": "MemTotal:  9000 kB\nMemAvailable:    4000 kB\nHugePages_Total:       0\n"}


def test_on_linux_the_memory_of_the_machine_counts(tmp_path: Path) -> None:
    assert list(memory.linux(tree(tmp_path, MEMINFO))) == [4000 * 1024]


def test_every_level_of_a_cgroup_counts_and_what_files_hold_is_given_back(tmp_path: Path) -> None:
    files = {
        "proc/self/cgroup": "0::/user/job\n",
        "proc/self/mountinfo": "30 23 0:26 / /sys/fs/cgroup rw,nosuid shared:4 - cgroup2 cgroup2 rw,nsdelegate\n",
        "sys/fs/cgroup/user/memory.max": "3000000\n",
        "sys/fs/cgroup/user/memory.current": "2000000\n",
        "sys/fs/cgroup/user/memory.stat": "anon 5\ninactive_file 500000\n",
        "sys/fs/cgroup/user/job/memory.max": "max\n",
        "sys/fs/cgroup/user/job/memory.current": "1000000\n",
    }
    assert list(memory.linux(tree(tmp_path, MEMINFO | files))) == [4000 * 1024, 1_500_000]


def test_cgroups_of_the_first_version_count(tmp_path: Path) -> None:
    """In a container the group is the mount, and its path leads nowhere inside."""
    files = {
        "proc/self/cgroup": "5:cpu:/docker/x\n4:memory:/docker/x\n0::/\n",
        "proc/self/mountinfo": "35 31 0:32 /docker/x /sys/fs/cgroup/memory ro - cgroup cgroup rw,memory\n"
        "41 31 0:38 / /sys/fs/cgroup/unified rw - cgroup2 cgroup2 rw\n",
        "sys/fs/cgroup/memory/memory.limit_in_bytes": "2000000",
        "sys/fs/cgroup/memory/memory.usage_in_bytes": "600000",
        "sys/fs/cgroup/memory/memory.stat": "total_inactive_file 100000\n",
    }
    assert list(memory.linux(tree(tmp_path, MEMINFO | files))) == [4000 * 1024, 1_500_000]


@LINUX
def test_limits_of_a_process_count() -> None:
    code = "from shviewer.memory import available_bytes\nprint(available_bytes())"
    free = int(in_a_process(code, address_space=GIB).stdout)
    assert 0 < free < GIB - 2**24  # what Python takes itself


def test_on_macos_free_and_inactive_pages_count() -> None:
    class Library:
        def mach_host_self(self) -> int:
            return 7

        def host_statistics64(self, host: int, flavour: int, counts: Any, filled: Any) -> int:
            assert (host, flavour) == (7, 4)
            counts._obj[0:4] = [10, 20, 30, 40]
            return 0

    assert list(memory.macos(Library(), 4096)) == [40 * 4096]


def test_on_windows_the_least_of_three_counts() -> None:
    class Kernel:
        def GlobalMemoryStatusEx(self, status: Any) -> int:
            assert status._obj.length == ctypes.sizeof(status._obj) == 64
            status._obj.left, status._obj.commit_left, status._obj.address_left = 3, 2, 9
            return 1

    assert min(memory.windows(Kernel())) == 2


# --- memory that runs out all the same


def test_running_out_of_memory_anywhere_is_one_line(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    def none_left(*_: Any, **__: Any) -> None:
        raise MemoryError

    right = project_mode.project_recipe
    monkeypatch.setattr(
        project_mode, "project_recipe", lambda one, *more: none_left() if one.light == "cosine" else right(one, *more)
    )
    assert main(["project", "cosine", "-o", str(tmp_path / "a.json")]) == LightError.exit_code
    assert capsys.readouterr().err == "shviewer: not enough memory for it; close something or make it smaller\n"
    assert main(["project", "cosine", "green", "-o", str(tmp_path / "out")]) == 1
    assert "shviewer: cosine: not enough memory" in capsys.readouterr().err
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["green.json"]
    monkeypatch.setattr("shviewer.cli.info.describe", none_left)
    assert main(["info", "green", "cosine"]) == LightError.exit_code
    assert capsys.readouterr().err.count("not enough memory for it") == 2


def test_a_window_without_memory_keeps_the_last_picture(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def none_left(*_: Any, **__: Any) -> None:
        raise MemoryError

    session = Session(state_of())
    monkeypatch.setattr("shviewer.viewer.desktop.behind.making.stages", none_left)
    session.press("Up")
    session.prepare()
    assert session.picture.light.name == "green"
    assert "not enough memory" in session.state.view.message
    assert capsys.readouterr().err == ""


# --- pipes


@POSIX
@pytest.mark.parametrize("name", ["sky.hdr", "key.toml", "list.json"])
def test_a_pipe_that_is_named_on_purpose_is_read_to_its_end(tmp_path: Path, name: str) -> None:
    content = {
        "sky.hdr": hdr_of_runs(64, 32),
        "key.toml": b'[[lobe]]\nprofile = "constant"\nradiance = 1\n',
        "list.json": json.dumps([[1, 2, 3]]).encode(),
    }[name]
    os.mkfifo(tmp_path / name)
    with ThreadPoolExecutor(1) as pool:
        written = pool.submit((tmp_path / name).write_bytes, content)
        light = find_light(str(tmp_path / name), Reading(convention="shviewer"))
        written.result(timeout=10)
    assert light.coefficients(1)[0, 0] > 0


@POSIX
def test_a_pipe_through_which_nothing_comes_is_one_line_after_its_time(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "sky.hdr")
    with pytest.raises(LightError, match=r"a pipe from which 0 bytes came in 0\.05 s, and no end"):
        read_bytes(tmp_path / "sky.hdr", Limits(pipe_seconds=0.05))
    held = os.open(tmp_path / "sky.hdr", os.O_RDWR)  # a writer that never ends
    os.write(held, b"#?")
    with pytest.raises(LightError, match="from which 2 bytes came"):
        read_bytes(tmp_path / "sky.hdr", Limits(pipe_seconds=0.05))
    os.write(held, b"12345")
    with pytest.raises(LightError, match="the limit is 4"):
        read_bytes(tmp_path / "sky.hdr", Limits(file_bytes=4))
    os.close(held)


@POSIX
def test_a_window_waits_for_no_pipe(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "sky.hdr")
    session = Session(state_of())
    session.drop(str(tmp_path / "sky.hdr"))
    session.prepare()
    assert "only a regular file is read" in session.state.view.message


# --- the one reader


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="there is no /dev/zero")
@pytest.mark.parametrize("name", ["a.toml", "a.py:f", "a.json", "a.csv", "a.npz", "a.png", "a.npy"])
def test_a_device_is_never_read_whatever_it_is_named(tmp_path: Path, name: str) -> None:
    (tmp_path / name.partition(":")[0]).symlink_to("/dev/zero")
    with pytest.raises(LightError, match="only a regular file is read"):
        find_light(str(tmp_path / name))
    assert main(["report", "green", "--against", "/dev/zero", "-o", str(tmp_path / "out")]) == 2


@pytest.mark.parametrize("text", [b"a" + b".a" * 30_000 + b"=1", b"[" + b"a." * 30_000 + b"a]"])
def test_a_key_of_thirty_thousand_dots_is_refused_before_it_is_parsed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, text: bytes
) -> None:
    """Python's reader of TOML takes 50 s and 4 GB for the first of them."""
    monkeypatch.setattr("tomllib.loads", lambda _: pytest.fail("it was parsed"))
    (tmp_path / "dots.toml").write_bytes(text)
    with pytest.raises(LightError, match="line 1 has 30000 dots; a line of a scene has at most 200"):
        find_light(str(tmp_path / "dots.toml"))


@pytest.mark.parametrize(
    ("more", "says"),
    [
        ({f"a{i}": ("int", bytes(4)) for i in range(5000)}, "more than 4096 attributes"),
        ({"note": ("string", b"x" * 2**24)}, "bytes of metadata"),
        ({"more": ("chlist", b"x" * 2**17 + b"x")}, "bytes of channels"),
    ],
    ids=["attributes", "metadata", "channels"],
)
def test_a_heavy_header_is_refused_before_the_library_sees_it(
    monkeypatch: pytest.MonkeyPatch, more: bytes, says: str
) -> None:
    """32 000 attributes took the library 3 s, and a list of 64 000 channels 7."""
    monkeypatch.setattr(openexr_headers, "open_openexr", lambda *_, **__: pytest.fail("the library was asked"))
    with pytest.raises(LightError, match=says):
        decode_openexr(flat_exr(32, 16, more=more))


def test_a_reference_of_another_size_is_not_decoded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    reference = tmp_path / "r.png"
    reference.write_bytes(flat_png(4096, 2048))
    monkeypatch.setattr(Image.Image, "convert", lambda *_: pytest.fail("it was decoded"))
    said = compare_with_reference(np.zeros((2, 4, 3), np.uint8), reference, tmp_path / "d.png", 0)
    assert said == f"{reference} is 4096 x 2048, the picture 4 x 2"


def test_a_stamp_from_elsewhere_does_not_lift_the_limit_of_memory() -> None:
    picture = picture_of()
    said = json.loads(metadata(picture, frame_of(picture), "none"))
    said["state"]["recipe"]["reading"]["limits"] |= {"memory_bytes": 2**60, "pipe_seconds": 10**9}
    limits = state_of_stamp(json.dumps(said)).recipe.reading.limits
    assert (limits.memory_bytes, limits.pipe_seconds) == (None, Limits().pipe_seconds)


class Watched(bytes):
    """The bytes of a file, which say when nobody holds them any more."""

    gone: Event

    def __del__(self) -> None:
        self.gone.set()


@pytest.mark.parametrize("isolated", [False, True])
def test_a_file_is_let_go_before_its_pixels_take_memory(monkeypatch: pytest.MonkeyPatch, isolated: bool) -> None:
    """A float32 file of 8192 x 4096 texels takes 300 MB, beside 400 of its planes and 400 of its pixels."""
    gone, held = Event(), []

    def read(path: Path, limits: Limits) -> bytes:
        data = Watched(flat_exr(32, 16))
        data.gone = gone
        return data

    def pixels(*arguments: Any) -> Any:
        held.append(not gone.wait(20.0 if isolated else 0.0))  # another thread hands them to the child
        return make(*arguments)

    owner, name = (isolated_module, "_read_halves") if isolated else (openexr.Planes, "decoded")
    make = getattr(owner, name)
    monkeypatch.setattr(radiance_files, "read_bytes", read)
    monkeypatch.setattr(owner, name, pixels)
    assert read_radiance_image(Path("a.exr"), Reading(isolated=isolated)).pixels.shape == (16, 32, 3)
    assert held == [False]


FRESH_PAGES = """
import resource
import numpy as np
from shviewer.memory import keep_freed
keep_freed()
pages = []
for _ in range(3):
    before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
    np.ones(2**18)
    pages.append(resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before)
print(*pages)
"""


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="another C library")
def test_an_array_takes_the_pages_of_one_that_was_freed() -> None:
    first, *later = map(int, subprocess.check_output([sys.executable, "-c", FRESH_PAGES], text=True).split())
    assert first > 400
    assert max(later) < first / 10
