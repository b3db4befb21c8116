# SPDX-License-Identifier: Apache-2.0
"""Global illumination with virtual point lights (VPLs) on OpenCL.

A picture in three lines:

    import nearlight
    session = nearlight.Session("scene.xml")
    session.render(width=640, height=480).write("picture.png")

Its parts:

    view = session.look(width=640, height=480)     # decides what the camera sees
    vpls = session.sample(view, vpl_count=1000)    # places VPLs for that
    picture = session.gather(view, vpls)           # makes pixels of them
    picture["indirect"]                            # a layer, as a NumPy array on the picture's memory
    vpls.lights()["position"]                      # the VPLs, as an array of records
    session.irradiance(points, normals, vpls)      # W/m² at points
    nearlight.Animation("walk.glb").render(24)     # a frame of an animated glTF file

Settings are keyword arguments, or objects such as ViewSettings with the same names. What fails raises
nearlight.Error; warnings go to the logger "nearlight". Ctrl-C and a progress function stop a picture between its steps.
"""

from ._comparison import Comparison, ComparisonRow, compare
from ._core import (
    Animation,
    AnimationOptions,
    BvhQuality,
    CameraPose,
    DeviceInfo,
    DeviceOptions,
    Devices,
    Difference,
    GatherKernel,
    GatherSettings,
    Image,
    IrradianceSettings,
    LoadOptions,
    Picture,
    PixelWindow,
    Policy,
    RenderSettings,
    SamplerKind,
    SamplingSettings,
    Scene,
    SceneNote,
    Session,
    SessionOptions,
    SunPosition,
    ToneCurve,
    View,
    ViewSettings,
    VplSet,
    WriteOptions,
    __version__,
    automatic_exposure,
    diff,
    diff_map,
    list_devices,
    load,
    picture_channels,
    read_image,
    read_linear_image,
)
from ._errors import Error, InvalidArgument

__all__ = [
    "Animation",
    "AnimationOptions",
    "BvhQuality",
    "CameraPose",
    "Comparison",
    "ComparisonRow",
    "DeviceInfo",
    "DeviceOptions",
    "Devices",
    "Difference",
    "Error",
    "GatherKernel",
    "GatherSettings",
    "Image",
    "InvalidArgument",
    "IrradianceSettings",
    "LoadOptions",
    "Picture",
    "PixelWindow",
    "Policy",
    "RenderSettings",
    "SamplerKind",
    "SamplingSettings",
    "Scene",
    "SceneNote",
    "Session",
    "SessionOptions",
    "SunPosition",
    "ToneCurve",
    "View",
    "ViewSettings",
    "VplSet",
    "WriteOptions",
    "__version__",
    "automatic_exposure",
    "compare",
    "diff",
    "diff_map",
    "list_devices",
    "load",
    "picture_channels",
    "read_image",
    "read_linear_image",
]
