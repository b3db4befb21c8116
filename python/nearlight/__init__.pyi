# SPDX-License-Identifier: Apache-2.0
# The types of the package. A test compares it with the module and with include/nearlight/settings.h.
import enum
import os
import pathlib
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from ._comparison import Comparison as Comparison
from ._comparison import ComparisonRow as ComparisonRow
from ._comparison import compare as compare
from ._errors import Error as Error
from ._errors import InvalidArgument as InvalidArgument

_Path = str | bytes | os.PathLike[Any]
_Vector = Sequence[float] | npt.NDArray[Any]
_Progress = Callable[[float], object]

__version__: str

class SamplerKind(enum.Enum):
    close_range = ...
    instant_radiosity = ...
    rejection = ...
    metropolis = ...
    bidirectional = ...
    local = ...

class Policy(enum.Enum):
    complete = ...
    paper = ...
    partition = ...

class GatherKernel(enum.Enum):
    automatic = ...
    packets = ...
    rays = ...

class BvhQuality(enum.Enum):
    fast = ...
    quality = ...

class ToneCurve(enum.Enum):
    linear = ...
    neutral = ...
    agx = ...
    filmic = ...

class CameraPose:
    def __init__(
        self,
        *,
        origin: _Vector = (0.0, 0.0, 0.0),
        target: _Vector = (0.0, 0.0, 0.0),
        up: _Vector | None = None,
        fov_x_degrees: float | None = None,
    ) -> None: ...
    origin: _Vector
    target: _Vector
    up: _Vector | None
    fov_x_degrees: float | None

class ViewSettings:
    def __init__(
        self,
        *,
        camera: CameraPose | None = None,
        width: int | None = None,
        height: int | None = None,
        range: float | None = None,
        clamp_radius: float | None = None,
        ray_budget_pilot: bool = True,
        max_depth: int | None = None,
    ) -> None: ...
    camera: CameraPose | None
    width: int | None
    height: int | None
    range: float | None
    clamp_radius: float | None
    ray_budget_pilot: bool
    max_depth: int | None

class SamplingSettings:
    def __init__(
        self,
        *,
        sampler: SamplerKind | str = "close_range",
        policy: Policy | str = "complete",
        vpl_count: int = 1000,
        cuts: bool = False,
        set_count: int | None = None,
        close_fraction: float | None = None,
    ) -> None: ...
    sampler: SamplerKind | str
    policy: Policy | str
    vpl_count: int
    cuts: bool
    set_count: int | None
    close_fraction: float | None

class PixelWindow:
    def __init__(self, *, x: int = 0, y: int = 0, width: int = 0, height: int = 0) -> None: ...
    x: int
    y: int
    width: int
    height: int

class GatherSettings:
    def __init__(
        self,
        *,
        samples_per_pixel: int = 16,
        strata: int | None = None,
        interleave: int = 1,
        window: PixelWindow | None = None,
        direct_samples_per_pixel: int | None = None,
        compensate: bool = True,
        rays_per_pixel: int = 64,
        indirect_only: bool = False,
        roulette: float = 0.0,
    ) -> None: ...
    samples_per_pixel: int
    strata: int | None
    interleave: int
    window: PixelWindow | None
    direct_samples_per_pixel: int | None
    compensate: bool
    rays_per_pixel: int
    indirect_only: bool
    roulette: float

class RenderSettings:
    def __init__(
        self,
        *,
        view: ViewSettings = ...,
        sampling: SamplingSettings = ...,
        gather: GatherSettings = ...,
        seed: int = 0,
        passes: int | None = None,
        seconds: float | None = None,
        error: float | None = None,
        pass_samples: Sequence[int] = [],
        camera: CameraPose | None = None,
        width: int | None = None,
        height: int | None = None,
        range: float | None = None,
        clamp_radius: float | None = None,
        ray_budget_pilot: bool = True,
        max_depth: int | None = None,
        sampler: SamplerKind | str = "close_range",
        policy: Policy | str = "complete",
        vpl_count: int = 1000,
        cuts: bool = False,
        set_count: int | None = None,
        close_fraction: float | None = None,
        samples_per_pixel: int = 16,
        strata: int | None = None,
        interleave: int = 1,
        window: PixelWindow | None = None,
        direct_samples_per_pixel: int | None = None,
        compensate: bool = True,
        rays_per_pixel: int = 64,
        indirect_only: bool = False,
        roulette: float = 0.0,
    ) -> None: ...
    view: ViewSettings
    sampling: SamplingSettings
    gather: GatherSettings
    seed: int
    passes: int | None
    seconds: float | None
    error: float | None
    pass_samples: Sequence[int]

class SessionOptions:
    def __init__(
        self, *, gather_kernel: GatherKernel | str = "automatic", bvh_quality: BvhQuality | str = "quality"
    ) -> None: ...
    gather_kernel: GatherKernel | str
    bvh_quality: BvhQuality | str

class IrradianceSettings:
    def __init__(self, *, direct_samples: int = 64, paths: int = 16) -> None: ...
    direct_samples: int
    paths: int

class SunPosition:
    def __init__(self, *, azimuth: float = 0.0, elevation: float = 0.0) -> None: ...
    azimuth: float
    elevation: float

class LoadOptions:
    def __init__(
        self,
        *,
        definitions: Mapping[str, str] = {},
        strict: bool = False,
        clear_glass: bool = False,
        camera: str = "",
        origin: _Vector | None = None,
        target: _Vector | None = None,
        up: _Vector | None = None,
        field_of_view: float | None = None,
        environment: str = "",
        environment_rotation: float = 0.0,
        environment_scale: float = 1.0,
        sun: SunPosition | None = None,
        light_scale: float = 1.0,
    ) -> None: ...
    definitions: Mapping[str, str]
    strict: bool
    clear_glass: bool
    camera: str
    origin: _Vector | None
    target: _Vector | None
    up: _Vector | None
    field_of_view: float | None
    environment: str
    environment_rotation: float
    environment_scale: float
    sun: SunPosition | None
    light_scale: float

class DeviceOptions:
    def __init__(self, *, kernel_dir: _Path = "", cache_dir: _Path = "") -> None: ...
    kernel_dir: _Path
    cache_dir: _Path

class WriteOptions:
    def __init__(self, *, exposure: float = 0.0, tone_curve: ToneCurve | str = "linear") -> None: ...
    exposure: float
    tone_curve: ToneCurve | str

class DeviceInfo:
    @property
    def index(self) -> int: ...
    @property
    def name(self) -> str: ...
    @property
    def platform(self) -> str: ...
    @property
    def version(self) -> str: ...
    @property
    def driver(self) -> str: ...
    @property
    def kind(self) -> str: ...
    @property
    def compute_units(self) -> int: ...
    @property
    def memory_bytes(self) -> int: ...
    @property
    def part(self) -> str: ...
    @property
    def unusable_because(self) -> str: ...

class Devices:
    def __init__(self, choice: str = "auto", *, kernel_dir: _Path = "", cache_dir: _Path = "") -> None: ...
    @property
    def infos(self) -> list[DeviceInfo]: ...
    def __len__(self) -> int: ...

class SceneNote:
    @property
    def file(self) -> pathlib.Path: ...
    @property
    def line(self) -> int: ...
    @property
    def text(self) -> str: ...

class Scene:
    @property
    def name(self) -> str: ...
    @property
    def source(self) -> pathlib.Path: ...
    @property
    def triangle_count(self) -> int: ...
    @property
    def bounds(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def camera(self) -> CameraPose: ...
    @property
    def notes(self) -> list[SceneNote]: ...
    def hash(self) -> int: ...

class Image:
    def __init__(self, values: npt.ArrayLike, channels: Sequence[str] | None = None) -> None: ...
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def channels(self) -> list[str]: ...
    @property
    def layers(self) -> list[str]: ...
    @property
    def values(self) -> npt.NDArray[np.float32]: ...
    def __getitem__(self, layer: str) -> npt.NDArray[np.float32]: ...
    def __contains__(self, layer: str) -> bool: ...
    def write(self, file: _Path, options: WriteOptions | None = None, *, exposure: float = 0.0) -> None: ...
    def _repr_png_(self) -> bytes | None: ...

class Difference:
    @property
    def rmse(self) -> float: ...
    @property
    def relative_mse(self) -> float: ...
    @property
    def mean_ratio(self) -> float: ...
    @property
    def flip(self) -> float: ...
    @property
    def non_finite(self) -> int: ...

class View:
    @property
    def width(self) -> int: ...
    @property
    def height(self) -> int: ...
    @property
    def range(self) -> float: ...
    @property
    def clamp_radius(self) -> float: ...
    @property
    def max_depth(self) -> int: ...

class VplSet:
    def __len__(self) -> int: ...
    @property
    def close_count(self) -> int: ...
    def lights(self) -> npt.NDArray[np.void]: ...

class Picture:
    @property
    def image(self) -> Image: ...
    @property
    def passes(self) -> int: ...
    @property
    def vpl_count(self) -> int: ...
    @property
    def interrupted(self) -> bool: ...
    @property
    def pass_samples(self) -> list[int]: ...
    @property
    def error(self) -> float | None: ...
    def __getitem__(self, layer: str) -> npt.NDArray[np.float32]: ...
    def write(self, file: _Path, options: WriteOptions | None = None, *, exposure: float = 0.0) -> None: ...
    def _repr_png_(self) -> bytes | None: ...

class Session:
    def __init__(
        self,
        scene: Scene | _Path,
        devices: Devices | str | int = "auto",
        options: SessionOptions | None = None,
        *,
        gather_kernel: GatherKernel | str = "automatic",
        bvh_quality: BvhQuality | str = "quality",
    ) -> None: ...
    def look(
        self,
        settings: ViewSettings | None = None,
        *,
        seed: int = 0,
        camera: CameraPose | None = None,
        width: int | None = None,
        height: int | None = None,
        range: float | None = None,
        clamp_radius: float | None = None,
        ray_budget_pilot: bool = True,
        max_depth: int | None = None,
    ) -> View: ...
    def sample(
        self,
        view: View,
        settings: SamplingSettings | None = None,
        *,
        seed: int = 0,
        sampler: SamplerKind | str = "close_range",
        policy: Policy | str = "complete",
        vpl_count: int = 1000,
        cuts: bool = False,
        set_count: int | None = None,
        close_fraction: float | None = None,
    ) -> VplSet: ...
    def gather(
        self,
        view: View,
        vpls: VplSet,
        settings: GatherSettings | None = None,
        *,
        seed: int = 0,
        progress: _Progress | None = None,
        samples_per_pixel: int = 16,
        strata: int | None = None,
        interleave: int = 1,
        window: PixelWindow | None = None,
        direct_samples_per_pixel: int | None = None,
        compensate: bool = True,
        rays_per_pixel: int = 64,
        indirect_only: bool = False,
        roulette: float = 0.0,
    ) -> Picture: ...
    def render(
        self,
        settings: RenderSettings | None = None,
        *,
        progress: _Progress | None = None,
        view: ViewSettings = ...,
        sampling: SamplingSettings = ...,
        gather: GatherSettings = ...,
        seed: int = 0,
        passes: int | None = None,
        seconds: float | None = None,
        error: float | None = None,
        pass_samples: Sequence[int] = [],
        camera: CameraPose | None = None,
        width: int | None = None,
        height: int | None = None,
        range: float | None = None,
        clamp_radius: float | None = None,
        ray_budget_pilot: bool = True,
        max_depth: int | None = None,
        sampler: SamplerKind | str = "close_range",
        policy: Policy | str = "complete",
        vpl_count: int = 1000,
        cuts: bool = False,
        set_count: int | None = None,
        close_fraction: float | None = None,
        samples_per_pixel: int = 16,
        strata: int | None = None,
        interleave: int = 1,
        window: PixelWindow | None = None,
        direct_samples_per_pixel: int | None = None,
        compensate: bool = True,
        rays_per_pixel: int = 64,
        indirect_only: bool = False,
        roulette: float = 0.0,
    ) -> Picture: ...
    def irradiance(
        self,
        points: npt.ArrayLike,
        normals: npt.ArrayLike,
        vpls: VplSet,
        settings: IrradianceSettings | None = None,
        *,
        seed: int = 0,
        direct_samples: int = 64,
        paths: int = 16,
    ) -> npt.NDArray[np.float32]: ...

def list_devices() -> list[DeviceInfo]: ...
def load(
    file: _Path,
    options: LoadOptions | None = None,
    *,
    definitions: Mapping[str, str] = {},
    strict: bool = False,
    clear_glass: bool = False,
    camera: str = "",
    origin: _Vector | None = None,
    target: _Vector | None = None,
    up: _Vector | None = None,
    field_of_view: float | None = None,
    environment: str = "",
    environment_rotation: float = 0.0,
    environment_scale: float = 1.0,
    sun: SunPosition | None = None,
    light_scale: float = 1.0,
) -> Scene: ...
def read_image(file: _Path) -> Image: ...
def picture_channels() -> list[str]: ...
def diff(image: Image, reference: Image, layer: str = "beauty") -> Difference: ...
def diff_map(image: Image, reference: Image, layer: str = "beauty") -> Image: ...
