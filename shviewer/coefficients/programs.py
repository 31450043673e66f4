"""The programs whose conventions are known, and where each was looked up.

All of them store c(l, m) in the row l(l+1) + m, unless a list of rows says otherwise (parts/rows.py). "Ours" are shviewer's
axes: x ahead (the centre of a lat-long image), y to the left, z up, right-handed. Where a program loads lat-long images
itself, its axes are those in which it sees ours.

filament    `IndirectLight::Builder::irradiance` [include/filament/IndirectLight.h]: irradiance over pi, "pre-scaled", so
            that the value is the plain sum of sh[i] times 1, y, z, x, xy, yz, 3z^2-1, zx, x^2-y^2
            [libs/ibl/src/CubemapSH.cpp, preprocessSHForShader, renderPreScaledSH3Bands]; 1 to 3 bands, float3 sh[n^2]; what
            cmgen writes into sh.txt. y up, right-handed; the image's centre is +z and its right -x:
            equirectangularToCubemap [CubemapUtils.cpp] looks up atan2(x, z), and cmgen mirrors x unless --no-mirror is
            given.
three       three.js, `SphericalHarmonics3` [src/math/SphericalHarmonics3.js]: radiance, orthonormal without phase (band 1
            is 0.488603 times y, z, x), 3 bands, 27 numbers row by row (fromArray); the shader applies A(l)
            (getIrradianceAt). y up, right-handed; the image's centre is +x and its right +z [ShaderChunk common.glsl,
            equirectUv].
unity       `SphericalHarmonicsL2` as ShadeSH9 evaluates it [CGIncludes/UnityCG.cginc]: the sum of sh[c, i] times the same
            polynomials as filament's is the irradiance over pi. How the seven vectors unity_SHAr ... unity_SHC come from
            sh[c, i] is in PackCoefficients of HDRP [Runtime/Lighting/SphericalHarmonics.cs]. 3 bands, indexed [channel, i].
            y up, left-handed; the image's centre is +x and its right -z [Skybox/Panoramic, ToRadialCoords], without a
            rotation of the sky.
unreal      `TSHVector` [Core/Public/Math/SHMath.h, Core/Private/Math/SHMath.cpp]: orthonormal with phase (band 1 is
            0.488603 times -y, z, -x), V[l(l+1) + m] for each of R, G, B; its tables hold 3 bands. Radiance:
            SetupSkyIrradianceEnvironmentMapConstants [Renderer, SceneRendering.cpp] applies A(l)/pi when it packs them
            for the shader. z up, left-handed; the image's centre is -y and its right +x [TextureCompressorModule.cpp,
            LookupLongLat with y and z swapped]. For coefficients with x ahead and y to the right, write unreal,z-up-left.
ambix       C. Nachbar et al., "AmbiX - A Suggested Ambisonics Format", Ambisonics Symposium 2011, as RFC 8486 and the IEM
            Plug-in Suite [plugins.iem.at/docs/compatibility] use it: ACN order, SN3D, no phase; channel W is the plain
            integral. Azimuth from ahead to the left, elevation up: x ahead, y left, z up. The numbers are what an encoder
            makes, integrals with SN3D functions; the function is the sum of (2l+1)/(4 pi) times them times those. (The
            paper's own formula could not be looked up; some texts divide by sqrt(4 pi).)
sphericart  F. Bigi et al. (2023), `SphericalHarmonics(l_max).compute(xyz)`: orthonormal, no phase, columns l(l+1) + m.
scipy       `scipy.special.sph_harm_y(l, m, theta, phi)`: orthonormal complex functions with phase, theta from +z. A real
            function has complex coefficients with c(l, -m) = (-1)^m conj(c(l, m)).
babylon     Babylon.js, `SphericalHarmonics.FromArray` and `SphericalPolynomial.FromHarmonics`
            [Maths/sphericalPolynomial.ts]: orthonormal with phase (SH3ylmBasisConstants), 9 rows, summed without A(l) by a
            material that is lit by spherical harmonics: irradiance over pi. y up, left-handed, the image's centre at +z and
            its right at +x; a right-handed scene takes the same numbers. Rendered: 5e-4.
playcanvas  PlayCanvas, `StandardMaterial.ambientSH` [ambient.js of its shader chunks]: the sum of 1, x, y, z, xz, zy, yx,
            3z^2-1, x^2-y^2; y up, in the axes of Filament. Rendered: 3e-4. ClayGL has the same order. (Its own
            shFromCubemap scales every band by 16 pi/51.)
cesium      CesiumJS, `ImageBasedLighting.sphericalHarmonicCoefficients` [Shaders/Builtin/Functions/sphericalHarmonics.js]:
            Filament's polynomials and quantity; x, y, z are the model's local x (east), z (up) and -y (south). Here the
            image's centre is local +x and its left +y, unmirrored. (cmgen --no-mirror, as its documentation has it, gives
            -y+z+x, which is mirrored.) Rendered: 0.7 % at 8 bits.
gltf        EXT_lights_image_based as Babylon.js reads it [loaders, EXT_lights_image_based.ts]: irradiance, orthonormal with
            phase, which the loader divides by pi. The text of the extension fixes neither sign, scale nor axes, and other
            readers disagree. Rendered: 0.06 %.
godot       Godot 4, probes of `LightmapGIData` [lightmapper_rd/lm_compute.glsl, MODE_LIGHT_PROBES]: orthonormal without
            phase, radiance over pi; the renderer multiplies by A(l) [scene_forward_clustered.glsl]. y up, right-handed; the
            image's centre is +z and its right -x, as the baker looks panoramas up.
3dgs        3D Gaussian splatting [graphdeco-inria/gaussian-splatting, utils/sh_utils.py, eval_sh, RGB2SH]: orthonormal with
            phase, the colour is 0.5 plus the sum. Colours are those of the training images, mostly encoded for a display;
            axes are free. f_dc_0..2 are row 0 of the channels, f_rest the other rows of red, then green, then blue.
directxmath DirectXMath, `XMSHEvalDirection`, `SHProjectCubeMap` [SHMath/DirectXSH.cpp]: orthonormal with phase, 2 to 6
            bands ("order"), an array a channel. y up, left-handed; the cube's front is +z and its right +x.
e3nn        `o3.spherical_harmonics(..., normalization="integral")`: orthonormal without phase about y, so that l = 1 is
            x, y, z; 1 to 13 bands. For a client with other axes write those, such as e3nn,y-up.
shtools     SHTOOLS, `SHCoeffs.from_array(SHVectorToCilm(rows))`: by default 4-pi-normalised without phase. In `cilm[i, l,
            m]` i = 1 holds -m; the rows here are those of SHCilmToVector.
spharpy     spharpy 1.0, `SphericalHarmonics` of real functions: orthonormal (N3D, in its sense), no phase, rows l(l+1) + m.
fuma        B-format of up to third order, W X Y Z R S T U V K ... Q: SN3D times a weight of each channel, no phase, x
            ahead, y left, z up; like ambix what an encoder makes. (The weights are D. Malham's of 1999; F. Adriaensen's
            table has the same.)
mitsuba     Mitsuba 3 and Dr.Jit, `dr.sh_eval(direction, order)`: orthonormal with phase, order 0 to 9; y up, right-handed,
            the frame of `envmap`, where the image's centre is +z and its right -x.
webxr, arcore, arkit
            `XRLightEstimate.sphericalHarmonicsCoefficients`, `getEnvironmentalHdrAmbientSphericalHarmonics` and
            `ARDirectionalLightEstimate`: containers and axes (y up, right-handed) are documented, the sign of the phase is
            not, and readers disagree: Google's hello_ar has it, its Unity SDK and three.js' XREstimatedLight have not;
            Unity's ARKit plug-in has it "from observation". Hence each has two names. A lamp overhead makes row 1 negative
            with phase, positive without.
"""

from __future__ import annotations

from functools import partial

from shviewer.coefficients.convention import Convention
from shviewer.coefficients.parts.axes import Axes
from shviewer.coefficients.parts.channels import FLAT_BY_CHANNEL
from shviewer.coefficients.parts.quantities import OVER_PI, RADIANCE_OVER_PI
from shviewer.harmonics.quantities.names import IRRADIANCE, RADIANCE

OURS = Convention()

_of_nine_rows = partial(Convention, most_bands=3, fewest_bands=3)
"""The convention of a program that takes three bands, no more and no fewer."""

_PROGRAMS = (
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
    _of_nine_rows(
        "three",
        "three.js, SphericalHarmonics3.fromArray",
        phase=False,
        axes=Axes("+x+z-y"),
        quantity=RADIANCE,
        layout="27 numbers, row by row",
    ),
    _of_nine_rows(
        "unity",
        "Unity, SphericalHarmonicsL2",
        phase=False,
        axes=Axes("+x+z+y"),
        scale="polynomial",
        quantity=OVER_PI,
        layout="sh[channel, row]",
    ),
    _of_nine_rows(
        "unreal",
        "Unreal Engine, TSHVectorRGB",
        axes=Axes("-y-x+z"),
        quantity=RADIANCE,
        layout="R.V[row], G.V[row], B.V[row]",
    ),
    Convention("ambix", "ambiX (ACN, SN3D)", phase=False, scale="sn3d", layout="one channel per row"),
    Convention("sphericart", "sphericart, SphericalHarmonics", phase=False),
    Convention("scipy", "SciPy, special.sph_harm_y", complex=True),
    _of_nine_rows(
        "babylon",
        "Babylon.js, SphericalHarmonics.FromArray",
        axes=Axes("-y+z+x"),
        quantity=OVER_PI,
        layout="9 rows of red, green, blue",
    ),
    _of_nine_rows(
        "playcanvas",
        "PlayCanvas, StandardMaterial.ambientSH",
        phase=False,
        axes=Axes("+y+z+x"),
        scale="polynomial",
        quantity=OVER_PI,
        order="order-playcanvas",
        layout="27 numbers, row by row",
    ),
    _of_nine_rows(
        "cesium",
        "CesiumJS, ImageBasedLighting.sphericalHarmonicCoefficients",
        phase=False,
        axes=Axes("+x+z-y"),
        scale="polynomial",
        quantity=OVER_PI,
        layout="9 Cartesian3",
    ),
    _of_nine_rows(
        "gltf",
        "glTF, EXT_lights_image_based as Babylon.js reads it",
        axes=Axes("-y+z+x"),
        quantity=IRRADIANCE,
        layout="irradianceCoefficients, 9 rows of red, green, blue",
    ),
    _of_nine_rows(
        "godot",
        "Godot, probes of LightmapGIData",
        phase=False,
        axes=Axes("+y+z+x"),
        quantity=RADIANCE_OVER_PI,
        layout="9 colours a probe",
    ),
    Convention(
        "3dgs",
        "3D Gaussian splatting, f_dc and f_rest",
        quantity=RADIANCE,
        shift=0.5,
        most_bands=4,
        layout="f_dc of row 0, then f_rest, all of red, of green, of blue",
    ),
    Convention(
        "directxmath",
        "DirectXMath, XMSHEvalDirection",
        axes=Axes("-y+z+x"),
        quantity=RADIANCE,
        most_bands=6,
        fewest_bands=2,
        layout="one array a channel",
    ),
    Convention(
        "e3nn", "e3nn, o3.spherical_harmonics", phase=False, pole=Axes("+z+x+y"), most_bands=13, layout="[..., row]"
    ),
    Convention(
        "shtools",
        "SHTOOLS, SHVectorToCilm",
        phase=False,
        scale="4pi",
        order="order-cilm",
        layout="cilm[0, l, m] of m >= 0, cilm[1, l, m] of -m, an array a channel",
    ),
    Convention("spharpy", "spharpy, SphericalHarmonics", phase=False, layout="[..., row]"),
    Convention(
        "fuma",
        "FuMa B-format (W X Y Z R S T U V K ... Q)",
        phase=False,
        scale="fuma",
        order="order-fuma",
        most_bands=4,
        layout="one channel per row",
    ),
    Convention("mitsuba", "Mitsuba 3, sh_eval", axes=Axes("+y+z+x"), most_bands=10, layout="(order+1)^2 numbers"),
    *(
        _of_nine_rows(
            f"{name}-{'phase' if phase else 'no-phase'}",
            f"{program}, read {'with' if phase else 'without'} the Condon-Shortley phase",
            phase=phase,
            axes=Axes("+x+z-y"),
            quantity=RADIANCE,
            layout=layout,
            sequence=FLAT_BY_CHANNEL if name == "arkit" else "",
        )
        for name, program, layout in (
            ("webxr", "WebXR, XRLightEstimate", "27 numbers, row by row"),
            ("arcore", "ARCore, environmental HDR", "27 numbers, row by row"),
            ("arkit", "ARKit, ARDirectionalLightEstimate", "27 numbers, channel by channel"),
        )
        for phase in (True, False)
    ),
)

CONVENTIONS = {convention.name: convention for convention in _PROGRAMS}

READINGS = {
    name: tuple(one for one in CONVENTIONS if one.startswith(f"{name}-")) for name in ("webxr", "arcore", "arkit")
}
"""Programs whose phase is documented nowhere -> the names of both readings."""

SHADED_WITH = ("three", "unreal", "godot", *(reading for readings in READINGS.values() for reading in readings))
"""Programs that hold radiance, and multiply it by A(l) before they show it: what they show is the irradiance."""
