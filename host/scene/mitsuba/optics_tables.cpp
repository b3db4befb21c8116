// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/optics_tables.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "host/base/words.h"
#include "host/scene/mitsuba/values.h"

namespace nearlight::core::mitsuba {
namespace {

// Measured spectra [Palik, Handbook of Optical Constants of Solids, and the SOPRA database], reduced to
// linear sRGB as Mitsuba 3's `conductor` does with its data/ior files (mitsuba.traverse, 3.9.1).
constexpr std::pair<std::string_view, Metal> kMetals[] = {
    {"a-C", {{2.9440f, 2.2271f, 1.9682f}, {0.8875f, 0.7993f, 0.8153f}}},
    {"Ag", {{0.1553f, 0.1167f, 0.1384f}, {4.8284f, 3.1222f, 2.1469f}}},
    {"Al", {{1.6575f, 0.8804f, 0.5212f}, {9.2238f, 6.2695f, 4.8370f}}},
    {"AlAs", {{3.6053f, 3.2329f, 2.2163f}, {0.0007f, 0.0000f, 0.0075f}}},
    {"AlSb", {{0.0000f, 4.1394f, 4.6692f}, {0.0000f, 0.0940f, 1.3006f}}},
    {"Au", {{0.1430f, 0.3753f, 1.4421f}, {3.9830f, 2.3856f, 1.6034f}}},
    {"Be", {{4.1850f, 3.1850f, 2.7841f}, {3.8355f, 3.0101f, 2.8690f}}},
    {"Cr", {{4.3697f, 2.9165f, 1.6549f}, {5.2066f, 4.2313f, 3.7547f}}},
    {"CsI", {{2.1449f, 1.7023f, 1.6624f}, {0.0000f, 0.0000f, 0.0000f}}},
    {"Cu", {{0.2010f, 0.9237f, 1.1022f}, {3.9133f, 2.4531f, 2.1421f}}},
    {"Cu_palik", {{0.2132f, 0.9197f, 1.1024f}, {3.9219f, 2.4573f, 2.1366f}}},
    {"Cu2O", {{3.5518f, 2.9499f, 2.7519f}, {0.1142f, 0.1939f, 0.6061f}}},
    {"CuO", {{3.2475f, 2.4478f, 2.2102f}, {0.5211f, 0.5700f, 0.7222f}}},
    {"d-C", {{2.7087f, 2.3188f, 2.2289f}, {0.0000f, 0.0000f, 0.0000f}}},
    {"Hg", {{2.3989f, 1.4400f, 0.9096f}, {6.3276f, 4.3719f, 3.4218f}}},
    {"HgTe", {{4.7790f, 3.2312f, 2.6599f}, {1.6316f, 1.5808f, 1.7293f}}},
    {"Ir", {{3.0863f, 2.0822f, 1.6179f}, {5.5922f, 4.0671f, 3.2673f}}},
    {"K", {{0.0640f, 0.0464f, 0.0382f}, {2.1042f, 1.3489f, 0.9131f}}},
    {"Li", {{0.2658f, 0.1956f, 0.2210f}, {3.5402f, 2.3111f, 1.6686f}}},
    {"MgO", {{2.0896f, 1.6507f, 1.5949f}, {0.0000f, 0.0000f, 0.0000f}}},
    {"Mo", {{4.4840f, 3.5251f, 2.7763f}, {4.1114f, 3.4208f, 3.1506f}}},
    {"Na_palik", {{0.0603f, 0.0561f, 0.0620f}, {3.1793f, 2.1125f, 1.5790f}}},
    {"Nb", {{3.4201f, 2.7901f, 2.3956f}, {3.4414f, 2.7377f, 2.5798f}}},
    {"Ni_palik", {{2.3673f, 1.6634f, 1.4671f}, {4.4988f, 3.0501f, 2.3454f}}},
    {"Rh", {{2.5858f, 1.8602f, 1.5543f}, {6.7823f, 4.7030f, 3.9761f}}},
    {"Se", {{4.0583f, 2.8429f, 2.8209f}, {0.7540f, 0.6384f, 0.5218f}}},
    {"Se-e", {{5.7228f, 4.1657f, 4.0813f}, {0.8711f, 1.1052f, 1.5653f}}},
    {"SiC", {{3.1723f, 2.5260f, 2.4794f}, {0.0000f, 0.0000f, 0.0000f}}},
    {"SnTe", {{4.5243f, 1.9816f, 1.2816f}, {0.0000f, 0.0000f, 0.0000f}}},
    {"Ta", {{2.0627f, 2.3929f, 2.6279f}, {2.4084f, 1.7415f, 1.9470f}}},
    {"Te", {{7.3902f, 4.4821f, 2.6371f}, {3.2560f, 3.5271f, 3.2921f}}},
    {"Te-e", {{7.5089f, 4.2964f, 2.3700f}, {5.5839f, 4.9472f, 3.9976f}}},
    {"ThF4", {{1.8307f, 1.4422f, 1.3877f}, {0.0000f, 0.0000f, 0.0000f}}},
    {"TiC", {{3.7005f, 2.8374f, 2.5823f}, {3.2656f, 2.3516f, 2.1728f}}},
    {"TiN", {{1.6484f, 1.1505f, 1.3798f}, {3.3683f, 1.9435f, 1.1021f}}},
    {"TiO2", {{3.4566f, 2.8017f, 2.9052f}, {0.0001f, 0.0000f, 0.0006f}}},
    {"TiO2-e", {{3.1066f, 2.5132f, 2.5824f}, {0.0000f, 0.0000f, 0.0002f}}},
    {"VC", {{3.6576f, 2.7527f, 2.5327f}, {3.0683f, 2.1987f, 1.9632f}}},
    {"V_palik", {{4.2776f, 3.5130f, 2.7611f}, {3.4913f, 2.8895f, 3.1115f}}},
    {"VN", {{2.8656f, 2.1192f, 1.9401f}, {3.0322f, 2.0561f, 1.6163f}}},
    {"W", {{4.3708f, 3.3003f, 2.9984f}, {3.5006f, 2.6049f, 2.2732f}}},
    {"none", {{0.0f, 0.0f, 0.0f}, {1.0f, 1.0f, 1.0f}}},
};

constexpr std::string_view kOnlySopra[] = {"a-C", "Ag", "Al", "Au", "Cr", "Cu", "W", "none"};

constexpr std::pair<std::string_view, double> kIndices[] = {
    {"bk7", 1.5046},
    {"water", 1.333},
    {"air", 1.000277},
    {"vacuum", 1},
    {"diamond", 2.419},
    {"acrylic glass", 1.49},
    {"polypropylene", 1.49},
    {"glycerol", 1.4729},
    {"benzene", 1.501},
    {"fused quartz", 1.458},
    {"pyrex", 1.47},
    {"helium", 1.000036},
    {"hydrogen", 1.000132},
    {"carbon dioxide", 1.00045},
    {"acetone", 1.36},
    {"ethanol", 1.361},
    {"silicone oil", 1.52045},
    {"carbon tetrachloride", 1.461},
    {"bromine", 1.661},
    {"water ice", 1.31},
    {"sodium chloride", 1.544},
    {"amber", 1.55},
    {"pet", 1.575},
};

}  // namespace

// Palik's data go by two names, with exceptions: those of SOPRA have no second one.
std::optional<Metal> find_metal(const std::string& name) {
    for (const auto& [known, metal] : kMetals) {
        if (known == name || (name.ends_with("_palik") && name.substr(0, name.size() - 6) == known &&
                              !std::ranges::count(kOnlySopra, known))) {
            return metal;
        }
    }
    return std::nullopt;
}

std::optional<double> find_index_of_refraction(const std::string& name) {
    const std::string wanted = lower_case(name);
    for (const auto& [known, index] : kIndices) {
        if (known == wanted) {
            return index;
        }
    }
    return std::nullopt;
}

}  // namespace nearlight::core::mitsuba
