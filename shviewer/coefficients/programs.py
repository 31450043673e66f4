"""The programs whose conventions are known, and where each was looked up.

All of them store c(l, m) at l(l+1) + m. "Ours" are shviewer's axes: x ahead (the centre of a lat-long image), y to the left, z
up, right-handed. Where a program loads lat-long images itself, its axes are those in which it sees ours.

filament    `IndirectLight::Builder::irradiance` [include/filament/IndirectLight.h]: irradiance over pi, "pre-scaled", so that
            the value is the plain sum of sh[i] times 1, y, z, x, xy, yz, 3z^2-1, zx, x^2-y^2 [libs/ibl/src/CubemapSH.cpp,
            preprocessSHForShader, renderPreScaledSH3Bands]; 1 to 3 bands, float3 sh[n^2]; what cmgen writes into sh.txt.
            y up, right-handed; the image's centre is +z and its right -x: equirectangularToCubemap [CubemapUtils.cpp] looks
            up atan2(x, z), and cmgen mirrors x unless --no-mirror is given.
three       three.js, `SphericalHarmonics3` [src/math/SphericalHarmonics3.js]: radiance, orthonormal without phase (band 1 is
            0.488603 times y, z, x), 3 bands, 27 numbers row by row (fromArray); the shader applies A(l) (getIrradianceAt).
            y up, right-handed; the image's centre is +x and its right +z [ShaderChunk common.glsl, equirectUv].
unity       `SphericalHarmonicsL2` as ShadeSH9 evaluates it [CGIncludes/UnityCG.cginc]: the sum of sh[c, i] times the same
            polynomials as filament's is the irradiance over pi. How the seven vectors unity_SHAr ... unity_SHC come from
            sh[c, i] is in PackCoefficients of HDRP [Runtime/Lighting/SphericalHarmonics.cs].
            3 bands, indexed [channel, i]. y up, left-handed; the image's centre is +x and its right -z [Skybox/Panoramic,
            ToRadialCoords], without a rotation of the sky.
unreal      `TSHVector` [Core/Public/Math/SHMath.h, Core/Private/Math/SHMath.cpp]: orthonormal with phase (band 1 is 0.488603
            times -y, z, -x), V[l(l+1) + m] for each of R, G, B; its tables hold 3 bands. Radiance: SetupSkyIrradiance-
            EnvironmentMapConstants [Renderer, SceneRendering.cpp] applies A(l)/pi when it packs them for the shader.
            z up, left-handed; the image's centre is -y and its right +x [TextureCompressorModule.cpp, LookupLongLat with y and
            z swapped]. For coefficients with x ahead and y to the right, write unreal,z-up-left.
ambix       C. Nachbar et al., "AmbiX - A Suggested Ambisonics Format", Ambisonics Symposium 2011, as RFC 8486 and the IEM
            Plug-in Suite [plugins.iem.at/docs/compatibility] use it: ACN order, SN3D, no phase; channel W is the plain
            integral. Azimuth from ahead to the left, elevation up: x ahead, y left, z up. The numbers are what an
            encoder makes, integrals with SN3D functions; the function is the sum of (2l+1)/(4 pi) times them times those.
            (The paper's own formula could not be looked up; some texts divide by sqrt(4 pi).)
sphericart  F. Bigi et al. (2023), `SphericalHarmonics(l_max).compute(xyz)`: orthonormal, no phase, columns l(l+1) + m.
scipy       `scipy.special.sph_harm_y(l, m, theta, phi)`: orthonormal complex functions with phase, theta from +z. A real
            function has complex coefficients with c(l, -m) = (-1)^m conj(c(l, m)).
"""

from __future__ import annotations

from dataclasses import replace

from shviewer.coefficients.axes import NAMED_AXES, Axes
from shviewer.coefficients.convention import OVER_PI, QUANTITIES, RADIANCE, SCALES, Convention

OURS = Convention()

CONVENTIONS = {
    convention.name: convention
    for convention in (
        OURS,
        Convention(
            "filament",
            "Filament, IndirectLight::Builder::irradiance",
            phase=False,
            axes=Axes("+y+z+x"),
            scale="polynomial",
            quantity=OVER_PI,
            most_bands=3,
            layout="float3 sh[n*n]",
        ),
        Convention(
            "three",
            "three.js, SphericalHarmonics3.fromArray",
            phase=False,
            axes=Axes("+x+z-y"),
            quantity=RADIANCE,
            most_bands=3,
            filled_up=True,
            layout="27 numbers, row by row",
        ),
        Convention(
            "unity",
            "Unity, SphericalHarmonicsL2",
            phase=False,
            axes=Axes("+x+z+y"),
            scale="polynomial",
            quantity=OVER_PI,
            most_bands=3,
            filled_up=True,
            layout="sh[channel, row]",
        ),
        Convention(
            "unreal",
            "Unreal Engine, TSHVectorRGB",
            axes=Axes("-y-x+z"),
            quantity=RADIANCE,
            most_bands=3,
            filled_up=True,
            layout="R.V[row], G.V[row], B.V[row]",
        ),
        Convention("ambix", "ambiX (ACN, SN3D)", phase=False, scale="sn3d", layout="one channel per row"),
        Convention("sphericart", "sphericart, SphericalHarmonics", phase=False),
        Convention("scipy", "SciPy, special.sph_harm_y", complex=True),
    )
}

MODIFIERS = ("phase", "no-phase", "m-swapped", *QUANTITIES, *SCALES, *NAMED_AXES)


def parse_convention(text: str) -> Convention:
    """The convention of a text: a name and modifiers, such as "three,z-up" or "shviewer,no-phase,4pi,irradiance".

    Names are those of CONVENTIONS, modifiers those of MODIFIERS, or axes such as "+x+z-y". ValueError for an unknown one, and
    for a modifier that contradicts the program or another modifier.
    """
    name, *modifiers = (part.strip() for part in text.split(","))
    if name not in CONVENTIONS:
        raise ValueError(f"convention {name!r}: it must be one of {', '.join(CONVENTIONS)}")
    convention, said = CONVENTIONS[name], dict[str, str]()
    for modifier in modifiers:
        kind, convention = _modified(convention, modifier)
        if said.setdefault(kind, modifier) != modifier:
            raise ValueError(f"convention {text!r}: {said[kind]} and {modifier} contradict each other")
    return convention


def _modified(convention: Convention, modifier: str) -> tuple[str, Convention]:
    """The aspect that the modifier changes, and the convention changed."""
    if modifier in QUANTITIES:
        fixed = CONVENTIONS[convention.name].quantity
        if fixed not in (None, modifier):
            raise ValueError(f"{modifier} contradicts {convention.name}, which takes {fixed}")
        return "quantity", convention.holding(modifier)
    if modifier in NAMED_AXES or modifier[:1] in ("+", "-"):
        return "axes", replace(convention, axes=Axes.named(modifier))
    if modifier in ("phase", "no-phase"):
        return "phase", _if_free(convention, modifier, "phase", modifier == "phase")
    if modifier == "m-swapped":
        return "order", _if_free(convention, modifier, "mirrored", True)
    if modifier in SCALES:
        return "scale", _if_free(convention, modifier, "scale", modifier)
    raise ValueError(
        f"convention modifier {modifier!r}: it must be one of {', '.join(MODIFIERS)}, or axes such as +x+z-y"
    )


def _if_free(convention: Convention, modifier: str, field: str, value: object) -> Convention:
    """Our own convention with a field changed. ValueError for another program's, which is fixed."""
    if convention.name != OURS.name and getattr(convention, field) != value:
        raise ValueError(f"{modifier} contradicts {convention.name}: it would not be what that program expects")
    changes: dict[str, object] = {field: value}
    if value == "polynomial":
        changes |= {"most_bands": 3, "phase": False}
    return replace(convention, **changes)  # type: ignore[arg-type]


def convention_text(convention: Convention) -> str:
    """The text that `parse_convention` turns into this convention again."""
    base = CONVENTIONS[convention.name]
    parts = [convention.name]
    if convention.axes != base.axes:
        parts.append(
            next((name for name, text in NAMED_AXES.items() if text == convention.axes.text), convention.axes.text)
        )
    if convention.scale != base.scale:
        parts.append(convention.scale)
    if convention.phase != base.phase and convention.scale != "polynomial":
        parts.append("phase" if convention.phase else "no-phase")
    if convention.mirrored != base.mirrored:
        parts.append("m-swapped")
    if convention.quantity != base.quantity and convention.quantity:
        parts.append(convention.quantity)
    return ",".join(parts)
