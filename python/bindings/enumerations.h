// SPDX-License-Identifier: Apache-2.0
// The enumerations of the module, as tables. A test compares the names with include/nearlight/.
#pragma once

#include <array>
#include <cstddef>

#include "nearlight/nearlight.h"

namespace nearlight::python {

/// A member of an enumeration. Its place in the table is its value in C++.
struct Member {
    const char* name;
    const char* text;  ///< what the member means, in one line
};

/// What the tables say about an enumeration: MembersOf<Enumeration>::name, ::text and ::members.
template <typename Enumeration>
struct MembersOf;

template <typename Enumeration>
constexpr const char* name_of(Enumeration value) {
    return MembersOf<Enumeration>::members[static_cast<std::size_t>(value)].name;
}

template <>
struct MembersOf<SamplerKind> {
    static constexpr const char* name = "SamplerKind";
    static constexpr const char* text = "How virtual point lights (VPLs) are chosen.";
    static constexpr std::array<Member, 6> members{
        {{"close_range", "patches close to the camera, sparse light walks elsewhere"},
         {"instant_radiosity", "light walks over the whole scene"},
         {"rejection", "light walks; VPLs that bring little are rejected"},
         {"metropolis", "Markov chains of light paths towards what the camera needs"},
         {"bidirectional", "light walks, and rays from what the camera sees"},
         {"local", "light walks with a wide clamp, and local lights per tile"}}};
    static_assert(static_cast<std::size_t>(SamplerKind::local) + 1 == members.size());
};

template <>
struct MembersOf<Policy> {
    static constexpr const char* name = "Policy";
    static constexpr const char* text = "The rule for deposits of light walks in the close range.";
    static constexpr std::array<Member, 3> members{
        {{"complete",
          "deposits of all depths share the light there with patches, and VPLs are drawn from both: "
          "unbiased"},
         {"paper", "deposits of all depths are dropped: loses light of several bounces"},
         {"partition", "deposits of depth 2 and more are kept: unbiased"}}};
    static_assert(static_cast<std::size_t>(Policy::partition) + 1 == members.size());
};

template <>
struct MembersOf<GatherKernel> {
    static constexpr const char* name = "GatherKernel";
    static constexpr const char* text = "Which kernel gathers. Both compute the same sum.";
    static constexpr std::array<Member, 3> members{{{"automatic", "packets on CPUs, rays elsewhere"},
                                                    {"packets", "a work-item takes up to 256 receivers"},
                                                    {"rays", "a work-item takes one receiver"}}};
    static_assert(static_cast<std::size_t>(GatherKernel::rays) + 1 == members.size());
};

template <>
struct MembersOf<BvhQuality> {
    static constexpr const char* name = "BvhQuality";
    static constexpr const char* text = "How much time the tree for rays is worth.";
    static constexpr std::array<Member, 2> members{
        {{"fast", "every triangle is in exactly one leaf"},
         {"quality", "fewer steps per ray, twice the time to build"}}};
    static_assert(static_cast<std::size_t>(BvhQuality::quality) + 1 == members.size());
};

template <>
struct MembersOf<ToneCurve> {
    static constexpr const char* name = "ToneCurve";
    static constexpr const char* text = "From linear light to what a screen shows.";
    static constexpr std::array<Member, 4> members{
        {{"linear", "as it is; what is above 1 is clipped"},
         {"neutral", "colours as they are up to 0.76, softly limited above"},
         {"agx", "a photograph's contrast, where bright colours fade to white"},
         {"filmic", "strong contrast of film"}}};
    static_assert(static_cast<std::size_t>(ToneCurve::filmic) + 1 == members.size());
};

}  // namespace nearlight::python
