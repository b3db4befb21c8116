# SPDX-License-Identifier: Apache-2.0
# The types of the compiled module. A test compares them with the module. Settings have the defaults of
# include/nearlight/settings.h, which help() shows.
import enum
import os
import pathlib
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from typing_extensions import TypedDict, Unpack, dataclass_transform

_Path = str | bytes | os.PathLike[Any]
_Vector = Sequence[float] | npt.NDArray[Any]
_Progress = Callable[[float], object]

__version__: str

class SamplerKind(enum.Enum):
    close_range = "close_range"
    instant_radiosity = "instant_radiosity"
    rejection = "rejection"
    metropolis = "metropolis"
    bidirectional = "bidirectional"
    local = "local"

class Policy(enum.Enum):
    complete = "complete"
    paper = "paper"
    partition = "partition"

class GatherKernel(enum.Enum):
    automatic = "automatic"
    packets = "packets"
    rays = "rays"

class BvhQuality(enum.Enum):
    fast = "fast"
    quality = "quality"

class ToneCurve(enum.Enum):
    linear = "linear"
    neutral = "neutral"
    agx = "agx"
    filmic = "filmic"

@dataclass_transform(kw_only_default=True)
class _Settings: ...

class CameraPose(_Settings):
    origin: _Vector = ...
    target: _Vector = ...
    up: _Vector | None = ...
    fov_x_degrees: float | None = ...

class _ViewSettings(TypedDict, total=False):
    camera: CameraPose | None
    width: int | None
    height: int | None
    range: float | None
    clamp_radius: float | None
    ray_budget_pilot: bool
    max_depth: int | None

class ViewSettings:
    def __init__(self, **fields: Unpack[_ViewSettings]) -> None: ...
    camera: CameraPose | None
    width: int | None
    height: int | None
    range: float | None
    clamp_radius: float | None
    ray_budget_pilot: bool
    max_depth: int | None

class _SamplingSettings(TypedDict, total=False):
    sampler: SamplerKind | str
    policy: Policy | str
    vpl_count: int
    cuts: bool
    set_count: int | None
    close_fraction: float | None
    file: _Path

class SamplingSettings:
    def __init__(self, **fields: Unpack[_SamplingSettings]) -> None: ...
    sampler: SamplerKind | str
    policy: Policy | str
    vpl_count: int
    cuts: bool
    set_count: int | None
    close_fraction: float | None
    file: _Path

class PixelWindow(_Settings):
    x: int = ...
    y: int = ...
    width: int = ...
    height: int = ...

class _GatherSettings(TypedDict, total=False):
    samples_per_pixel: int
    strata: int | None
    interleave: int
    window: PixelWindow | None
    direct_samples_per_pixel: int | None
    compensate: bool
    rays_per_pixel: int
    refine: bool
    splat: bool
    indirect_only: bool
    shared_limit: float | None
    roulette: float
    spread_single_samples: bool

class GatherSettings:
    def __init__(self, **fields: Unpack[_GatherSettings]) -> None: ...
    samples_per_pixel: int
    strata: int | None
    interleave: int
    window: PixelWindow | None
    direct_samples_per_pixel: int | None
    compensate: bool
    rays_per_pixel: int
    refine: bool
    splat: bool
    indirect_only: bool
    shared_limit: float | None
    roulette: float
    spread_single_samples: bool

class _RenderSettings(_ViewSettings, _SamplingSettings, _GatherSettings, total=False):
    view: ViewSettings
    sampling: SamplingSettings
    gather: GatherSettings
    seed: int
    passes: int | None
    seconds: float | None
    error: float | None
    pass_samples: Sequence[int]

class RenderSettings:
    def __init__(self, **fields: Unpack[_RenderSettings]) -> None: ...
    view: ViewSettings
    sampling: SamplingSettings
    gather: GatherSettings
    seed: int
    passes: int | None
    seconds: float | None
    error: float | None
    pass_samples: Sequence[int]

class _SessionOptions(TypedDict, total=False):
    gather_kernel: GatherKernel | str
    bvh_quality: BvhQuality | str

class SessionOptions:
    def __init__(self, **fields: Unpack[_SessionOptions]) -> None: ...
    gather_kernel: GatherKernel | str
    bvh_quality: BvhQuality | str

class _IrradianceSettings(TypedDict, total=False):
    direct_samples: int
    paths: int

class IrradianceSettings:
    def __init__(self, **fields: Unpack[_IrradianceSettings]) -> None: ...
    direct_samples: int
    paths: int

class _AnimationOptions(TypedDict, total=False):
    fps: float
    animations: Sequence[str | int]
    vpl_keys: int | None

class AnimationOptions:
    def __init__(self, **fields: Unpack[_AnimationOptions]) -> None: ...
    fps: float
    animations: Sequence[str | int]
    vpl_keys: int | None

class SunPosition(_Settings):
    azimuth: float = ...
    elevation: float = ...

class _LoadOptions(TypedDict, total=False):
    definitions: Mapping[str, str | float]
    strict: bool
    clear_glass: bool
    camera: str | int
    origin: _Vector | None
    target: _Vector | None
    up: _Vector | None
    fov_x_degrees: float | None
    environment: str
    environment_rotation: float
    environment_scale: float
    sun: SunPosition | None
    light_scale: float

class LoadOptions:
    def __init__(self, **fields: Unpack[_LoadOptions]) -> None: ...
    definitions: Mapping[str, str | float]
    strict: bool
    clear_glass: bool
    camera: str | int
    origin: _Vector | None
    target: _Vector | None
    up: _Vector | None
    fov_x_degrees: float | None
    environment: str
    environment_rotation: float
    environment_scale: float
    sun: SunPosition | None
    light_scale: float

class _DeviceOptions(TypedDict, total=False):
    kernel_dir: _Path
    cache_dir: _Path

class DeviceOptions:
    def __init__(self, **fields: Unpack[_DeviceOptions]) -> None: ...
    kernel_dir: _Path
    cache_dir: _Path

class _WriteOptions(TypedDict, total=False):
    exposure: float
    tone_curve: ToneCurve | str

class WriteOptions:
    def __init__(self, **fields: Unpack[_WriteOptions]) -> None: ...
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
    def __init__(self, choice: str | int = "auto", **options: Unpack[_DeviceOptions]) -> None: ...
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
    def has_open_exposure(self) -> bool: ...
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
    def write(self, file: _Path, options: WriteOptions | None = None, **fields: Unpack[_WriteOptions]) -> None: ...
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
    def write(self, file: _Path, options: WriteOptions | None = None, **fields: Unpack[_WriteOptions]) -> None: ...
    def _repr_png_(self) -> bytes | None: ...

class Session:
    def __init__(
        self,
        scene: Scene | _Path,
        devices: Devices | str | int = "auto",
        options: SessionOptions | None = None,
        **fields: Unpack[_SessionOptions],
    ) -> None: ...
    def look(
        self,
        settings: ViewSettings | None = None,
        *,
        seed: int = 0,
        **fields: Unpack[_ViewSettings],
    ) -> View: ...
    def sample(
        self,
        view: View,
        settings: SamplingSettings | None = None,
        *,
        seed: int = 0,
        **fields: Unpack[_SamplingSettings],
    ) -> VplSet: ...
    def save_vpls(self, vpls: VplSet, file: _Path) -> None: ...
    def gather(
        self,
        view: View,
        vpls: VplSet,
        settings: GatherSettings | None = None,
        *,
        seed: int = 0,
        progress: _Progress | None = None,
        **fields: Unpack[_GatherSettings],
    ) -> Picture: ...
    def render(
        self,
        settings: RenderSettings | None = None,
        *,
        progress: _Progress | None = None,
        **fields: Unpack[_RenderSettings],
    ) -> Picture: ...
    def irradiance(
        self,
        points: npt.ArrayLike,
        normals: npt.ArrayLike,
        vpls: VplSet,
        settings: IrradianceSettings | None = None,
        *,
        seed: int = 0,
        **fields: Unpack[_IrradianceSettings],
    ) -> npt.NDArray[np.float32]: ...

class Animation:
    def __init__(
        self,
        file: _Path,
        devices: Devices | str | int = "auto",
        options: AnimationOptions | None = None,
        *,
        load: LoadOptions | None = None,
        session: SessionOptions | None = None,
        **fields: Unpack[_AnimationOptions],
    ) -> None: ...
    @property
    def begin(self) -> float: ...
    @property
    def end(self) -> float: ...
    def render(
        self,
        frame: int,
        settings: RenderSettings | None = None,
        *,
        progress: _Progress | None = None,
        **fields: Unpack[_RenderSettings],
    ) -> Picture: ...

def list_devices() -> list[DeviceInfo]: ...
def load(file: _Path, options: LoadOptions | None = None, **fields: Unpack[_LoadOptions]) -> Scene: ...
def read_image(file: _Path) -> Image: ...
def read_linear_image(file: _Path) -> Image: ...
def picture_channels() -> list[str]: ...
def automatic_exposure(image: Image) -> float: ...
def diff(image: Image, reference: Image, layer: str = "beauty") -> Difference: ...
def diff_map(image: Image, reference: Image, layer: str = "beauty") -> Image: ...
