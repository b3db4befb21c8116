# SPDX-License-Identifier: Apache-2.0
# The compiled module; its types are in __init__.pyi.
from . import Policy as Policy
from . import SamplerKind as SamplerKind
from . import SamplingSettings as SamplingSettings
from . import diff as diff
