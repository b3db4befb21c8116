// SPDX-License-Identifier: Apache-2.0
#include "host/bench/segment_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "host/base/files.h"
#include "host/reference/synthetic_scene.h"
#include "tests/image/temporary_folder.h"
#include "tests/support/error_matchers.h"

namespace nearlight::core::test {
namespace {

template <typename Action>
void expect_refusal(const std::string& text, Action&& action) {
    const Error error = error_of(std::forward<Action>(action));
    EXPECT_EQ(error.kind(), ErrorKind::file);
    EXPECT_TRUE(mentions(error, text));
}

constexpr std::size_t kHeaderBytes = 48;  // including the magic number

class SegmentFile : public testing::Test {
  protected:
    SegmentFile() {
        const Scene scene = make_sphere_room(2'000);
        segments_ = make_camera_segments(scene, build_scene_bvh(scene), 5, 20, 12);
        segments_.vpls[3].power = {1.0f, 0.5f, 0.25f};
        write_segments(file_, segments_);
        bytes_ = read_bytes(file_);
    }

    /// Reads the file with `value` written at `offset`.
    template <typename T>
    GatherSegments read_with(std::size_t offset, T value) {
        std::string bytes = bytes_;
        std::memcpy(bytes.data() + offset, &value, sizeof value);
        write_text(file_, bytes);
        return read_segments(file_);
    }
    [[nodiscard]] std::size_t triangles_at() const {
        return kHeaderBytes + segments_.geometry.vertices.size() * sizeof(Vec3);
    }
    [[nodiscard]] std::size_t vpls_at() const {
        return triangles_at() + segments_.geometry.triangles.size() * 12;
    }
    [[nodiscard]] std::size_t receivers_at() const { return vpls_at() + segments_.vpls.size() * 36; }
    /// Of a packet, only the places of its receivers are stored.
    [[nodiscard]] std::size_t rays_at() const {
        return receivers_at() + segments_.receivers.size() * offsetof(ReceiverPacket, surface);
    }

    TemporaryFolder folder_;
    std::filesystem::path file_ = folder_ / "room.segments";
    GatherSegments segments_;
    std::string bytes_;
};

TEST_F(SegmentFile, ComesBackAsItWas) {
    const GatherSegments read = read_segments(file_);
    EXPECT_EQ(read.geometry.name, "room");
    ASSERT_EQ(read.geometry.vertices.size(), segments_.geometry.vertices.size());
    for (std::size_t i = 0; i < read.geometry.vertices.size(); ++i) {
        EXPECT_EQ(read.geometry.vertices[i].position, segments_.geometry.vertices[i].position);
    }
    ASSERT_EQ(read.geometry.triangles.size(), segments_.geometry.triangles.size());
    EXPECT_EQ(std::memcmp(read.geometry.triangles.data(), segments_.geometry.triangles.data(),
                          read.geometry.triangles.size() * sizeof(Triangle)),
              0);
    ASSERT_EQ(read.vpls.size(), 5u);
    for (std::size_t i = 0; i < read.vpls.size(); ++i) {
        EXPECT_EQ(read.vpls[i].position, segments_.vpls[i].position);
        EXPECT_EQ(read.vpls[i].normal, segments_.vpls[i].normal);
        EXPECT_EQ(read.vpls[i].power, segments_.vpls[i].power);
    }
    ASSERT_EQ(read.receivers.size(), segments_.receivers.size());
    EXPECT_EQ(std::memcmp(read.receivers.data(), segments_.receivers.data(),
                          read.receivers.size() * sizeof(ReceiverPacket)),
              0);
    EXPECT_EQ(read.rays, segments_.rays);
    EXPECT_GT(count_bits(read.rays), 0u);
    EXPECT_EQ(read.clamp_radius, segments_.clamp_radius);
}

TEST_F(SegmentFile, HasTheDocumentedSize) {
    EXPECT_EQ(bytes_.substr(0, 8), "NLSEGM01");
    EXPECT_EQ(bytes_.size(), rays_at() + segments_.rays.size() * 8);
}

TEST_F(SegmentFile, RefusesOtherLengths) {
    for (const std::size_t size : {std::size_t{0}, std::size_t{7}, std::size_t{8}, kHeaderBytes - 1,
                                   kHeaderBytes, bytes_.size() / 2, bytes_.size() - 1}) {
        write_text(file_, bytes_.substr(0, size));
        expect_refusal("room.segments", [&] { read_segments(file_); });
    }
    write_text(file_, bytes_ + "x");
    expect_refusal("bytes", [&] { read_segments(file_); });
    expect_refusal("none", [&] { read_segments(folder_ / "none"); });
}

TEST_F(SegmentFile, RefusesWrongHeaders) {
    EXPECT_NO_THROW(read_with(0, 'N'));
    expect_refusal("NLSEGM01", [&] { read_with(0, 'X'); });
    expect_refusal("NLSEGM01", [&] { read_with(7, '2'); });
    for (const std::size_t count : {8, 12, 16, 20}) {
        expect_refusal("bytes", [&] { read_with(count, 0xffffffffu); });
        expect_refusal("bytes", [&] { read_with(count, 0u); });
    }
    expect_refusal("announces", [&] { read_with(24, count_bits(segments_.rays) + 1); });
    expect_refusal("clamp radius", [&] { read_with(32, std::nanf("")); });
    expect_refusal("limits", [&] { read_with(36, 0.0f); });
    expect_refusal("header", [&] { read_with(44, 1u); });
}

// With these counts, 2^64 bytes follow the header, which 64 bits count as none.
TEST_F(SegmentFile, RefusesCountsWhoseBytesOverflow) {
    std::string bytes = bytes_.substr(0, kHeaderBytes);
    const std::uint32_t counts[] = {603, 0, 2147483447, 1073741824};
    std::memcpy(bytes.data() + 8, counts, sizeof counts);
    write_text(file_, bytes);
    expect_refusal("words of rays", [&] { read_segments(file_); });
}

TEST_F(SegmentFile, RefusesWrongContents) {
    const float infinity = std::numeric_limits<float>::infinity();
    const auto vertices = static_cast<uint>(segments_.geometry.vertices.size());
    const std::size_t last_receiver =
        receivers_at() + segments_.receivers.size() * offsetof(ReceiverPacket, surface) - 4;
    expect_refusal("vertex", [&] { read_with(kHeaderBytes + 4, infinity); });
    expect_refusal("vertex", [&] { read_with(triangles_at() + 8, vertices); });
    expect_refusal("VPL", [&] { read_with(vpls_at() + 32, infinity); });
    expect_refusal("receiver", [&] { read_with(last_receiver, infinity); });
    // The picture has 20 × 12 pixels in tiles of 8 × 8, so the last tile has no receiver in its last lane.
    expect_refusal("not there", [&] { read_with(bytes_.size() - 8, ~std::uint64_t{0}); });
}

}  // namespace
}  // namespace nearlight::core::test
