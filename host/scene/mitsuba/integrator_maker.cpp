// SPDX-License-Identifier: Apache-2.0
#include "host/scene/mitsuba/integrator_maker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>

namespace nearlight::core::mitsuba {
namespace {

constexpr int kDirectDepth = 2;

// Different ways to compute the same picture.
constexpr std::array<std::string_view, 18> kPathIntegrators{
    "path",      "volpath",    "volpath_simple", "volpathmis", "ptracer", "prb",
    "prb_basic", "prbvolpath", "bdpt",           "mlt",        "pssmlt",  "erpt",
    "ppm",       "sppm",       "photonmapper",   "vpl",        "vrl",     "prb_projective"};
constexpr std::array<std::string_view, 2> kDirectIntegrators{"direct", "direct_projective"};
// These render the picture of another integrator, which is nested in them, along with something else.
constexpr std::array<std::string_view, 4> kWrappers{"aov", "moment", "irrcache", "adaptive"};

// These show something else than light.
constexpr std::array<std::string_view, 7> kOtherPictures{"ao",     "depth",  "field",       "motion",
                                                         "stokes", "normal", "multichannel"};

template <std::size_t N>
bool is_one_of(const std::array<std::string_view, N>& names, const Object& object) {
    return std::ranges::find(names, object.type) != names.end();
}

int path_depth(const Object& integrator) {
    constexpr double kVplDepth = 5.0;  // without a word about it, Mitsuba 0.6 stops VPLs at this depth
    const double depth = integrator.number("max_depth", integrator.type == "vpl" ? kVplDepth : -1.0);
    constexpr double kMaxPathLength = 1e6;
    const bool is_limit = depth >= 1.0 && depth <= kMaxPathLength && depth == std::floor(depth);
    if (depth != -1.0 && !is_limit) {
        fail(integrator.find("max_depth")->where,
             "'max_depth' should be -1 (unlimited), or a whole number from 1 (emission only) to 1000000");
    }
    return depth < 0.0 ? kUnlimitedPathDepth : static_cast<int>(depth);
}

/// Marks as known what only says how a picture is computed, in Mitsuba 0.5 to 3, and how fast.
void ignore_ways_to_compute(const Object& integrator) {
    integrator.ignore({"rr_depth", "samples_per_pass", "block_size", "timeout", "strict_normals"});
    integrator.ignore({"shading_samples", "direct_samples", "glossy_samples", "luminance_samples"});
    integrator.ignore({"use_spectral_mis", "sppc", "sppp", "sppi", "guiding", "guiding_proj",
                       "guiding_rounds", "light_image", "sample_direct", "brute_force", "granularity"});
    integrator.ignore({"global_photons", "caustic_photons", "volume_photons", "global_lookup_radius",
                       "caustic_lookup_radius", "lookup_size", "global_lookup_size", "caustic_lookup_size",
                       "volume_lookup_size", "gather_locally", "auto_cancel_gathering"});
    integrator.ignore(
        {"photon_count", "initial_radius", "alpha", "max_passes", "shadow_map_resolution", "clamping"});
    integrator.ignore({"bidirectional", "two_stage", "p_large", "bidirectional_mutation", "lens_perturbation",
                       "multi_chain_perturbation", "caustic_perturbation", "manifold_perturbation", "lambda",
                       "num_chains", "max_chains", "chain_length"});
    // These are of integrators that have another one in them.
    integrator.ignore({"aovs", "max_error", "p_value", "max_sample_factor", "resolution", "quality",
                       "quality_adjustment", "gradients", "clamp_neighbor", "clamp_screen", "overture"});
}

/// Reports properties that may change the picture, of integrators that are known.
void report_unknown_properties(const Object& integrator, NoteSink& notes) {
    ignore_ways_to_compute(integrator);
    integrator.report_unused(notes);
}

/// The integrator that `wrapper` renders along with something else.
const Object& wrapped(const Object& wrapper, NoteSink& notes) {
    const std::vector<const Object*> nested = wrapper.nested("integrator");
    if (nested.size() != 1) {
        fail(wrapper.where, "integrator '" + wrapper.type + "' needs one nested integrator");
    }
    if (wrapper.type == "aov" || wrapper.type == "moment") {
        notes.remark(
            *wrapper.where.file, wrapper.where.line,
            "integrator '" + wrapper.type +
                "' is left out; the picture is that of the integrator in it, with nearlight's layers");
    }
    return *nested.front();
}

/// The integrator that makes the picture.
const Object& innermost(const Object& integrator, NoteSink& notes) {
    constexpr int kMaxWrappers = 8;
    const Object* inner = &integrator;
    for (int depth = 0; is_one_of(kWrappers, *inner); ++depth) {
        if (depth == kMaxWrappers) {
            fail(inner->where,
                 "more than " + std::to_string(kMaxWrappers) + " integrators lie within each other");
        }
        const Object& wrapper = *inner;
        inner = &wrapped(wrapper, notes);
        report_unknown_properties(wrapper, notes);
    }
    return *inner;
}

}  // namespace

void apply_integrator(const Object& outermost, Scene& scene, NoteSink& notes) {
    const Object& integrator = innermost(outermost, notes);
    if (is_one_of(kOtherPictures, integrator)) {
        fail(integrator.where,
             "integrator '" + integrator.type +
                 "' is not supported, because it shows something else than light; use 'path'");
    }
    const bool is_direct = is_one_of(kDirectIntegrators, integrator);
    const bool is_known = is_direct || is_one_of(kPathIntegrators, integrator);
    if (!is_known) {
        note(
            notes, integrator.where,
            "unknown integrator '" + integrator.type + "' is taken for one that makes the picture of 'path'");
    }
    scene.max_depth = is_direct ? kDirectDepth : path_depth(integrator);
    scene.camera.hide_emitters = integrator.boolean("hide_emitters", false);
    if (is_direct) {
        for (const char* samples : {"emitter_samples", "bsdf_samples"}) {
            if (integrator.has(samples) && integrator.number(samples, 1.0) == 0.0) {
                note(notes, integrator.find(samples)->where,
                     std::string("'") + samples + "' of 0 is ignored; no light is left out");
            }
        }
    }
    if (is_known) {
        report_unknown_properties(integrator, notes);
    }
}

}  // namespace nearlight::core::mitsuba
