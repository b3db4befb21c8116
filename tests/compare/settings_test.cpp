// SPDX-License-Identifier: Apache-2.0
#include "host/compare/settings.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/error_matchers.h"

namespace nearlight::core {
namespace {

using test::error_of;
using test::mentions;

TEST(CompareMethods, AllOfThemAreFoundByTheirNames) {
    const std::vector<Method> methods = all_methods();
    EXPECT_EQ(methods.front(), default_method());
    EXPECT_EQ(methods.size(), all_samplers().size() + all_policies().size() - 1);
    for (const Method& method : methods) {
        EXPECT_EQ(parse_method(to_string(method)), method);
        EXPECT_EQ(std::ranges::count(methods, method), 1);
        EXPECT_EQ(file_stem(method).find(':'), std::string::npos);
    }
    EXPECT_EQ(parse_method("close-range"), default_method());
    EXPECT_EQ(parse_method("close-range:paper"), (Method{SamplerKind::close_range, Policy::paper}));
}

TEST(CompareMethods, AnUnknownNameListsTheKnownOnes) {
    for (const char* name : {"metro", "", "close-range:", "instant-radiosity:paper"}) {
        const Error error = error_of([&] { parse_methods(name); });
        EXPECT_EQ(error.kind(), ErrorKind::invalid_argument) << name;
        EXPECT_TRUE(mentions(error, "instant-radiosity")) << name;
        EXPECT_TRUE(mentions(error, "close-range:paper")) << name;
    }
}

TEST(CompareMethods, NoneIsNamedTwiceUnderWhateverName) {
    EXPECT_EQ(parse_methods("instant-radiosity,close-range:paper").size(), 2u);
    const std::string default_name = to_string(default_method());
    for (const std::string& list :
         {std::string("instant-radiosity,close-range,instant-radiosity"), "close-range," + default_name}) {
        const Error error = error_of([&] { parse_methods(list); });
        EXPECT_EQ(error.kind(), ErrorKind::invalid_argument);
        EXPECT_TRUE(mentions(error, "twice"));
    }
}

TEST(CompareLists, CountsAreSorted) {
    EXPECT_EQ(parse_vpl_counts("2000,100,500"), (std::vector<uint>{100, 500, 2000}));
}

TEST(CompareLists, WrongCountsAreNamed) {
    for (const char* list :
         {"0,abc", "abc", "", "100,", ",100", "100,,200", "-5", "1.5", "99999999999", "60000000", "1e3"}) {
        const Error error = error_of([&] { parse_vpl_counts(list); });
        EXPECT_EQ(error.kind(), ErrorKind::invalid_argument) << list;
        EXPECT_EQ(error.setting(), "vpls") << list;
    }
    EXPECT_TRUE(mentions(error_of([] { parse_vpl_counts("10,20,10"); }), "twice"));
}

/// The setting and the message of the Error that check_settings() throws after a change of the defaults.
template <typename Change>
std::string complaint(Change&& change) {
    CompareSettings settings;
    change(settings);
    const Error error = error_of([&] { check_settings(settings); });
    EXPECT_EQ(error.kind(), ErrorKind::invalid_argument);
    return std::string(error.setting()) + ": " + error.what();
}

TEST(CompareSettingsCheck, DefaultsAreFine) {
    EXPECT_NO_THROW(check_settings({}));
}

TEST(CompareSettingsCheck, WhatDoesNotGoTogetherIsRefused) {
    const auto has = [](const std::string& text, const char* part) {
        return text.find(part) != std::string::npos;
    };
    EXPECT_TRUE(has(complaint([](auto& s) { s.methods.clear(); }), "nothing to compare"));
    EXPECT_TRUE(has(complaint([](auto& s) { s.vpl_counts.clear(); }), "nothing to compare"));
    EXPECT_TRUE(
        has(complaint([](auto& s) { s.methods = parse_methods("instant-radiosity"); }), "baseline: "));
    EXPECT_TRUE(
        has(complaint([](auto& s) { s.clamp_radius = 0.1f, s.clamp_fraction = 0.1f; }), "clamp_fraction: "));
    EXPECT_TRUE(has(complaint([](auto& s) { s.max_depth = 2u; }), "max_depth: "));
    EXPECT_TRUE(has(complaint([](auto& s) { s.reference_vpls = 1000; }), "200000"));
    const Method metropolis = parse_method("metropolis");
    EXPECT_TRUE(has(complaint([&](auto& s) { s.reference_sampler = metropolis; }), "reference_vpls: "));
    EXPECT_TRUE(has(complaint([&](auto& s) { s.reference_sampler = metropolis, s.reference_vpls = 99'999; }),
                    "100000"));
    EXPECT_TRUE(has(complaint([](auto& s) {
                        s.reference_sampler = parse_method("close-range:paper"), s.reference_vpls = 200'000;
                    }),
                    "loses light"));
    EXPECT_TRUE(has(complaint([](auto& s) { s.reference_vpls = 200'000, s.reference_files = {"a.exr"}; }),
                    "either read from a file or made of VPLs"));
    EXPECT_TRUE(has(complaint([](auto& s) { s.crops = {{300, 0, 21, 10}}; }), "crop: the crop 21x10+300+0"));
}

}  // namespace
}  // namespace nearlight::core
