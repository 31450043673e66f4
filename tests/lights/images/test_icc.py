"""What shviewer.lights.images.display.icc promises about colour profiles."""

import io
import zlib

import numpy as np
import pytest
from helpers import to_srgb
from lights.images.hdr_files import assert_same
from lights.images.ldr_files import (
    ADOBE_COLUMNS,
    LINEAR_CURVE,
    P3_COLUMNS,
    RGB,
    SRGB_COLUMNS,
    SRGB_CURVE,
    gamma_curve,
    icc_profile,
    parametric_curve,
    png_file,
    saved_by_pillow,
    table_curve,
)
from PIL import Image, ImageCms

from shviewer.lights.images.display.colour import linear_from_srgb

CODES = np.random.default_rng(3).integers(0, 256, (16, 32, 3), np.uint8)
SRGB_TABLE = table_curve(linear_from_srgb(np.linspace(0, 1, 1024)))
COMPRESSED_REC709 = parametric_curve(3, 1 / 0.45, 1 / 1.099, 0.099 / 1.099, 1 / 4.5, 0.081)

PROFILES = {
    "GIMP built-in Linear sRGB": icc_profile("GIMP built-in Linear sRGB", curves=(LINEAR_CURVE,)),
    "sRGB-elle-V2-g10": icc_profile("sRGB-elle-V2-g10.icc", curves=(gamma_curve(1.0),)),
    "sRGB D50 gamma 1.8": icc_profile("sRGB D50 gamma 1.8", curves=(gamma_curve(1.8),)),
    "Adobe RGB (1998)": icc_profile("Adobe RGB (1998)", ADOBE_COLUMNS, (gamma_curve(563 / 256),)),
    "Display P3": icc_profile("Display P3", P3_COLUMNS),
    "of para 0": icc_profile("p", curves=(parametric_curve(0, 2.2),)),
    "of para 1": icc_profile("p", curves=(parametric_curve(1, 2.0, 0.9, 0.1),)),
    "of para 2": icc_profile("p", curves=(parametric_curve(2, 2.0, 0.8, 0.1, 0.05),)),
    "of para 4": icc_profile("p", curves=(parametric_curve(4, 2.4, 0.9, 0.05, 0.1, 0.1, 0.01, 0.002),)),
    "of a table": icc_profile("t", curves=(table_curve([0, 0.01, 0.1, 0.4, 1.0]),)),
    "Rec. 709 of cameras": icc_profile("Rec709", curves=(COMPRESSED_REC709,)),
    "with another curve for each channel": icc_profile(
        "3", P3_COLUMNS, (gamma_curve(1.0), gamma_curve(1.8), SRGB_CURVE)
    ),
}


def as_lcms(codes, profile):
    """The sRGB codes that LittleCMS makes of codes in a profile, relative colorimetric, cut off at 0 and 255."""
    return np.asarray(
        ImageCms.profileToProfile(
            Image.fromarray(codes),
            io.BytesIO(profile),
            ImageCms.createProfile("sRGB"),
            renderingIntent=ImageCms.Intent.RELATIVE_COLORIMETRIC,
        )
    )


def srgb_codes(light):
    return 255 * to_srgb(np.clip(light, 0, 1))


@pytest.mark.parametrize("profile", PROFILES.values(), ids=PROFILES)
@pytest.mark.parametrize("kind", ["PNG", "JPEG"])
def test_a_profile_is_the_light_that_littlecms_makes_of_it(read, profile, kind):
    """LittleCMS works with 16 bit tables, and rounds to codes: 1.5 of them, where sRGB is steepest."""
    data = saved_by_pillow(CODES, kind, icc_profile=profile)
    codes = np.asarray(Image.open(io.BytesIO(data)).convert("RGB"))
    image = read(data, f"light.{kind.lower()}")
    np.testing.assert_allclose(srgb_codes(image.pixels), as_lcms(codes, profile), rtol=0, atol=1.5)
    assert any("is honoured" in note for note in image.notes)


@pytest.mark.parametrize("curve", [SRGB_CURVE, SRGB_TABLE])
def test_a_profile_that_is_srgb_under_any_name_is_read_as_srgb_without_a_note(read, curve):
    for name in ("sRGB IEC61966-2.1", "Kamera"):
        image = read(saved_by_pillow(CODES, icc_profile=icc_profile(name, curves=(curve,))), "light.png")
        assert_same(image.pixels, read(png_file(CODES, RGB), "light.png").pixels)
        assert len(image.notes) == 1
    own = ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes()
    assert len(read(saved_by_pillow(CODES, icc_profile=own), "light.png").notes) == 1


def test_what_is_taken_of_a_profile_is_said_with_its_name(read):
    def said(name, *more):
        return read(saved_by_pillow(CODES, icc_profile=icc_profile(name, *more)), "light.png")

    image = said("Display P3", P3_COLUMNS)
    assert image.notes[1] == (
        "its colour profile (ICC 'Display P3') is honoured: sRGB, primaries converted to Rec. 709"
    )
    image = said("g18", SRGB_COLUMNS, (gamma_curve(1.8),))
    assert image.notes[1].endswith("is honoured: gamma 1.8, primaries of Rec. 709")
    assert image.encoding == "PNG, 8 bit gamma 1.8 (LDR)"
    assert said("x\n\x1b[2J", P3_COLUMNS).notes[1].isprintable()


def test_a_profile_of_grey_gives_its_curve(read):
    profile = icc_profile("grey", (), (gamma_curve(1.0),), b"GRAY")
    image = read(saved_by_pillow(CODES[..., 0].copy(), icc_profile=profile), "light.png")
    np.testing.assert_allclose(image.pixels, np.repeat(CODES[..., :1] / 255, 3, axis=2), rtol=1e-6)


LUT = icc_profile("tables", (), (), more=((b"A2B0", b"mft2" + bytes(60)),))
NOT_READ = {
    "of tables": (LUT, "it has no curves and matrix"),
    "of CMYK": (icc_profile("c", (), (), b"CMYK"), "it is not for RGB or grey"),
    "of nothing": (b"desc sRGB IEC61966-2.1", "it is no profile"),
    "cut short": (PROFILES["Display P3"][:300], "it is cut short"),
    "of a flat matrix": (icc_profile("f", (SRGB_COLUMNS[0],) * 3), "its matrix makes no RGB space"),
    "of black": (icc_profile("b", ((0, 0, 0),) * 3), "its matrix makes no RGB space"),
    "of an unknown curve": (icc_profile("u", curves=(b"para" + bytes(4) + b"\0\x09" + bytes(30),)), "of no kind"),
    "of a curve cut short": (icc_profile("s", curves=(LINEAR_CURVE[:8] + b"\0\0\1\0",)), "its curve is cut short"),
    "of a curve that falls": (icc_profile("n", curves=(table_curve([1, 0.5, 0]),)), "its curve does not rise"),
    "of a curve without light": (icc_profile("n", curves=(gamma_curve(0),)), "its curve does not rise"),
    "of a curve without values": (icc_profile("n", curves=(parametric_curve(0, -5.0),)), "its curve does not rise"),
}  # fmt: skip


@pytest.mark.parametrize(("profile", "reason"), NOT_READ.values(), ids=NOT_READ)
def test_a_profile_that_is_not_read_is_said_to_be_ignored_and_why(read, profile, reason):
    image = read(saved_by_pillow(CODES, icc_profile=profile), "light.png")
    assert_same(image.pixels, read(png_file(CODES, RGB), "light.png").pixels)
    assert "is ignored (" in image.notes[1]
    assert reason in image.notes[1]
    assert image.notes[1].endswith("sRGB assumed")


def test_a_profile_in_pq_is_refused_as_a_chunk_in_pq_is(refusal):
    profile = icc_profile("Rec. 2100 PQ", more=((b"cicp", b"cicp" + bytes(4) + bytes((9, 16, 0, 1))),))
    assert "coded in PQ" in refusal(saved_by_pillow(CODES, icc_profile=profile), "light.png")


@pytest.mark.parametrize("seed", range(300))
def test_a_damaged_profile_never_stops_the_picture(read, seed):
    rng = np.random.default_rng(seed)
    profile = bytearray(list(PROFILES.values())[seed % len(PROFILES)])
    for place in rng.integers(0, len(profile), rng.integers(1, 20)):
        profile[place] = rng.integers(0, 256)
    png = png_file(CODES[:2, :2], RGB, extra=[(b"iCCP", b"x\0\0" + zlib.compress(bytes(profile)))])
    assert np.isfinite(read(png, "light.png").pixels).all()
