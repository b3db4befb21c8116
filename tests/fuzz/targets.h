// SPDX-License-Identifier: Apache-2.0
// What is fuzzed: one function for each kind of file that people and programs hand over. Each takes any
// bytes. It returns if the reader took them or refused them with an Error; everything else, from another
// exception to a crash, is a finding. libfuzzer.cpp makes a program of each function; replay_test.cpp runs
// all of them on the kept files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

namespace nearlight::core::fuzz {

using Bytes = std::span<const std::uint8_t>;

void fuzz_mitsuba(Bytes bytes);
void fuzz_obj(Bytes bytes);
void fuzz_mtl(Bytes bytes);
void fuzz_ply(Bytes bytes);
/// Sets of VPLs.
void fuzz_vpls(Bytes bytes);
/// Segments of `bench gather --replay`.
void fuzz_segments(Bytes bytes);
/// The first byte says whether the rest is a file as it is, or what is compressed in a file of some version.
void fuzz_serialized(Bytes bytes);
/// A .glb if it begins like one, else a .gltf.
void fuzz_gltf(Bytes bytes);
/// The first byte chooses the extension.
void fuzz_image(Bytes bytes);
/// The first byte says whether the lines follow on a head that fits the device and the kernels.
void fuzz_tunables(Bytes bytes);
/// The first byte chooses between the caches of programs, of trees and of measured cells. Of the first two, a
/// whole file is changed from a place on that the next two bytes tell.
void fuzz_cache(Bytes bytes);
/// The first byte says whether the rest is a file, or what stands in the header of one with a black pixel.
void fuzz_checkpoint(Bytes bytes);
/// Words of a command line, one a line; it is parsed, not run.
void fuzz_command_line(Bytes bytes);

struct Target {
    const char* name;
    void (*run)(Bytes bytes);
};
inline constexpr Target kTargets[] = {{"mitsuba", fuzz_mitsuba},
                                      {"obj", fuzz_obj},
                                      {"mtl", fuzz_mtl},
                                      {"ply", fuzz_ply},
                                      {"vpls", fuzz_vpls},
                                      {"segments", fuzz_segments},
                                      {"serialized", fuzz_serialized},
                                      {"gltf", fuzz_gltf},
                                      {"image", fuzz_image},
                                      {"tunables", fuzz_tunables},
                                      {"cache", fuzz_cache},
                                      {"checkpoint", fuzz_checkpoint},
                                      {"command_line", fuzz_command_line}};

/// The folder of this process, in memory where the system has such folders. It is removed at the end.
const std::filesystem::path& scratch_folder();
/// Writes a file there, and returns its path.
std::filesystem::path put(std::string_view name, Bytes bytes);
std::filesystem::path put(std::string_view name, std::string_view text);

}  // namespace nearlight::core::fuzz
