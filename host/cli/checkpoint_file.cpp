// SPDX-License-Identifier: Apache-2.0
// A file is kCheckpointMagic, the length of the header, the header as JSON, the sums, the values of the first
// pass, and a checksum of all that; numbers are little-endian, as on all machines that there are devices for.
#include "host/cli/checkpoint_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <utility>
#include <variant>

#include "host/base/files.h"
#include "host/base/hash.h"
#include "host/base/limits.h"
#include "host/cli/log.h"
#include "host/cli/pass_list.h"
#include "host/stages/receiver_paths.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

using Json = nlohmann::ordered_json;

/// How much of the magic all versions of the format have.
constexpr std::size_t kFamily = 6;
/// Bounds that only a file that somebody made up exceeds: it must not take more memory than its size.
constexpr std::size_t kMaxRecordedPasses = 2'000'000;
constexpr uint kMaxPassNumber = 2'000'000'000;
constexpr int kMaxDepth = 8;
constexpr std::uint64_t kMaxHeaderBytes = std::uint64_t{16} << 20u;
constexpr std::uint64_t kPixelBytes = PassSums::kSums * sizeof(DoubleSum) + PassSums::kFirsts * sizeof(float);
constexpr std::uint64_t kFrameBytes = kCheckpointMagic.size() + sizeof(std::uint64_t) + sizeof(Hash128);

[[noreturn]] void fail_to_read(const std::filesystem::path& file, const std::string& reason) {
    throw Error(ErrorKind::file, fmt::format("cannot read the checkpoint '{}': {}", file.string(), reason));
}

[[noreturn]] void fail_as_damaged(const std::filesystem::path& file) {
    fail_to_read(file, "it is damaged or incomplete; remove it and render anew");
}

Json to_json(const Metadata& metadata) {
    Json json = Json::object();
    for (const auto& [name, value] : metadata) {
        std::visit([&, key = name](const auto& item) { json[key] = item; }, value);
    }
    return json;
}

/// A whole number of 0 or more. Others make the file a damaged one, as what is no number does.
template <typename Integer>
Integer whole_in(const Json& json) {
    const std::uint64_t number = json.get_ref<const Json::number_unsigned_t&>();
    if (!std::in_range<Integer>(number)) {
        throw std::out_of_range("whole number");
    }
    return static_cast<Integer>(number);
}

const Json& object_in(const Json& json) {
    return json.is_object() ? json : throw std::out_of_range("object");
}

Metadata metadata_in(const Json& json) {
    Metadata metadata;
    for (const auto& [name, value] : json.items()) {
        if (value.is_number_integer()) {
            metadata[name] = value.get<int>();
        } else if (value.is_number()) {
            metadata[name] = value.get<float>();
        } else if (value.is_string()) {
            metadata[name] = value.get<std::string>();
        } else if (value.is_array()) {
            metadata[name] = value.get<std::vector<float>>();
        }
    }
    return metadata;
}

template <typename Value>
Json optional_json(const std::optional<Value>& value) {
    return value ? Json(*value) : Json(nullptr);
}

template <typename Value>
std::optional<Value> optional_in(const Json& json) {
    return json.is_null() ? std::nullopt : std::optional(json.get<Value>());
}

Json facts_json(const CheckpointFacts& facts) {
    Json json{{"version", facts.version},
              {"scene", hex_digits(facts.scene_hash)},
              {"settings", facts.settings},
              {"maker", facts.maker},
              {"metadata", to_json(facts.metadata)},
              {"tone_curve", to_string(facts.look.curve)},
              {"exposure", optional_json(facts.look.exposure)},
              {"place", nullptr}};
    if (const auto& place = facts.place) {
        json["place"] = {place->x, place->y, place->whole_width, place->whole_height};
    }
    return json;
}

ToneCurve tone_curve_in(const Json& json) {
    const auto found = std::ranges::find(kToneCurves, json.get<std::string>(),
                                         [](const auto& row) { return std::string(row.first); });
    if (found == kToneCurves.end()) {
        throw std::out_of_range("tone curve");
    }
    return found->second;
}

CheckpointFacts facts_in(const Json& json) {
    CheckpointFacts facts{.version = json.at("version"),
                          .scene_hash = std::stoull(json.at("scene").get<std::string>(), nullptr, 16),
                          .settings = object_in(json.at("settings")),
                          .maker = object_in(json.at("maker")),
                          .metadata = metadata_in(json.at("metadata")),
                          .look = {.curve = tone_curve_in(json.at("tone_curve")),
                                   .exposure = optional_in<float>(json.at("exposure"))},
                          .place = {}};
    if (const Json& place = json.at("place"); !place.is_null()) {
        facts.place = {whole_in<int>(place.at(0)), whole_in<int>(place.at(1)), whole_in<int>(place.at(2)),
                       whole_in<int>(place.at(3))};
    }
    return facts;
}

Json record_json(const PassRecord& record) {
    Json json{{"passes", Json::array()},
              {"begun_samples", record.begun_samples},
              {"begun_rows", record.begun_rows},
              {"choice", nullptr},
              {"close_fraction", record.close_fraction},
              {"close_vpls", record.totals.close_vpls},
              {"distant_vpls", record.totals.distant_vpls},
              {"sparse_vpls", record.totals.sparse_vpls},
              {"candidates", record.totals.candidates},
              {"local_lights", record.totals.local_lights},
              {"sample_seconds", optional_json(record.pace.sample_seconds)},
              {"vpl_seconds", record.pace.vpl_seconds}};
    for (const PassRange& range : record.whole) {
        json["passes"].push_back(
            {{"seed", range.seed}, {"first", range.first}, {"samples", pass_list_text(range.samples)}});
    }
    if (record.choice) {
        json["choice"] = {record.choice->range, record.choice->ray_budget.clamp_radius,
                          record.choice->ray_budget.direct_samples_per_pixel,
                          record.choice->ray_budget.shared_limit, record.choice->ray_budget.aimed_rays};
    }
    return json;
}

/// Throws unless settings may have these numbers.
void check(const PassChoice& choice) {
    const RayBudget& budget = choice.ray_budget;
    const float numbers[] = {choice.range, budget.clamp_radius, budget.shared_limit};
    const auto is_sound = [](float number) { return std::isfinite(number) && number >= 0.0f; };
    if (!std::ranges::all_of(numbers, is_sound) || budget.direct_samples_per_pixel == 0 ||
        budget.direct_samples_per_pixel > kMaxLightSamples || budget.aimed_rays > kMaxAimedRays) {
        throw std::out_of_range("choice");
    }
}

PassRecord record_in(const Json& json) {
    PassRecord record{.whole = {},
                      .begun_samples = whole_in<uint>(json.at("begun_samples")),
                      .begun_rows = whole_in<uint>(json.at("begun_rows")),
                      .choice = {},
                      .close_fraction = json.at("close_fraction"),
                      .totals = {.close_vpls = whole_in<std::size_t>(json.at("close_vpls")),
                                 .distant_vpls = whole_in<std::size_t>(json.at("distant_vpls")),
                                 .sparse_vpls = whole_in<std::size_t>(json.at("sparse_vpls")),
                                 .candidates = whole_in<std::size_t>(json.at("candidates")),
                                 .local_lights = whole_in<std::size_t>(json.at("local_lights"))},
                      .pace = {.sample_seconds = optional_in<double>(json.at("sample_seconds")),
                               .vpl_seconds = json.at("vpl_seconds")}};
    std::size_t passes = 0;
    for (const Json& range : json.at("passes")) {
        const std::string samples = range.at("samples");
        record.whole.push_back({.seed = whole_in<uint>(range.at("seed")),
                                .first = whole_in<uint>(range.at("first")),
                                .samples = samples.empty() ? std::vector<uint>() : parse_pass_list(samples)});
        // Each list is limited, but a short file could have many.
        passes += record.whole.back().samples.size();
        if (passes > kMaxRecordedPasses || record.whole.back().first > kMaxPassNumber) {
            throw std::length_error("passes");
        }
    }
    if (const Json& choice = json.at("choice"); !choice.is_null()) {
        record.choice = {.range = choice.at(0),
                         .ray_budget = {.clamp_radius = choice.at(1),
                                        .direct_samples_per_pixel = whole_in<uint>(choice.at(2)),
                                        .shared_limit = choice.at(3),
                                        .aimed_rays = whole_in<uint>(choice.at(4))}};
        check(*record.choice);
    }
    if (record.begun_samples > kMaxSamplesPerPixel) {
        throw std::length_error("samples");
    }
    return record;
}

/// Whether there can be such a record of a picture with `height` rows.
bool is_consistent(const PassRecord& record, std::size_t height) {
    const auto is_empty = [](const PassRange& range) { return range.samples.empty(); };
    const bool has_passes = !std::ranges::all_of(record.whole, is_empty);
    // Only a picture without a whole pass has an empty range, which says where it begins.
    const bool has_ranges =
        record.whole.size() == 1 || (has_passes && std::ranges::none_of(record.whole, is_empty));
    return has_ranges && (record.choice || !has_passes) && record.begun_rows < height &&
           (record.begun_samples == 0) == (record.begun_rows == 0);
}

/// The rows of the sums follow from the record.
void set_rows(const PassRecord& record, PassSums& sums) {
    PassSums::Row whole;
    for (const PassRange& range : record.whole) {
        for (const uint samples : range.samples) {
            whole.passes += 1;
            whole.samples += samples;
        }
    }
    const std::span<PassSums::Row> rows = sums.rows();
    for (std::size_t y = 0; y < rows.size(); ++y) {
        const bool is_begun = y < record.begun_rows;
        rows[y] = {whole.passes + (is_begun ? 1 : 0), whole.samples + (is_begun ? record.begun_samples : 0)};
    }
}

/// The parts of a file, but for the checksum of these.
std::vector<std::span<const std::byte>> parts_of(const std::array<std::uint64_t, 1>& header_size,
                                                 const std::string& header, const PassSums& sums) {
    return {std::as_bytes(std::span(kCheckpointMagic)), std::as_bytes(std::span(header_size)),
            std::as_bytes(std::span(header)), std::as_bytes(sums.sums()), std::as_bytes(sums.firsts())};
}

Hash128 checksum_of(std::span<const std::span<const std::byte>> parts) {
    Hasher hasher;
    for (const std::span<const std::byte> part : parts) {
        hasher.add_bytes(part);
    }
    return hasher.hash128();
}

}  // namespace

void write_checkpoint(const std::filesystem::path& file, const CheckpointFacts& facts,
                      const PassRecord& record, const PassSums& sums) {
    Json json = facts_json(facts);
    json["width"] = sums.width();
    json["height"] = sums.height();
    json["record"] = record_json(record);
    const std::string header = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    const std::array<std::uint64_t, 1> size{header.size()};
    std::vector<std::span<const std::byte>> parts = parts_of(size, header, sums);
    const Hash128 checksum = checksum_of(parts);
    parts.push_back(std::as_bytes(std::span(checksum)));
    write_parts(file, parts);
}

CheckpointReader::CheckpointReader(std::filesystem::path file) : file_(std::move(file)) {
    if (const std::string reason = reason_not_to_read(file_); !reason.empty()) {
        fail_to_read(file_, reason);
    }
    std::ifstream stream(file_, std::ios::binary);
    std::array<char, kCheckpointMagic.size()> magic{};
    if (!stream) {
        fail_to_read(file_, "it cannot be opened");
    }
    stream.read(magic.data(), magic.size());
    const std::string_view found(magic.data(), magic.size());
    if (!stream || found.substr(0, kFamily) != kCheckpointMagic.substr(0, kFamily)) {
        fail_to_read(file_, "it is no checkpoint of nearlight");
    }
    if (found != kCheckpointMagic) {
        fail_to_read(file_, "another version of nearlight wrote it; remove it and render anew");
    }
    try {
        take_header(stream);
    } catch (const std::exception&) {
        fail_as_damaged(file_);
    }
    const std::uint64_t size = kFrameBytes + header_.size() + std::uint64_t{width_} * height_ * kPixelBytes;
    std::error_code error;
    if (width_ < 1 || height_ < 1 || width_ > std::uint64_t{kMaxPictureSide} ||
        height_ > std::uint64_t{kMaxPictureSide} || !is_consistent(record_, height_) ||
        std::filesystem::file_size(file_, error) != size) {
        fail_as_damaged(file_);
    }
}

void CheckpointReader::take_header(std::istream& stream) {
    std::uint64_t length = 0;
    stream.read(reinterpret_cast<char*>(&length), sizeof length);
    if (!stream || length > kMaxHeaderBytes || length > std::filesystem::file_size(file_)) {
        throw std::length_error("header");
    }
    header_.resize(length);
    stream.read(header_.data(), static_cast<std::streamsize>(length));
    if (!stream) {
        throw std::length_error("header");
    }
    const Json json = Json::parse(header_, [](int depth, Json::parse_event_t, const Json&) {
        return depth <= kMaxDepth ? true : throw std::length_error("header");
    });
    facts_ = facts_in(json);
    record_ = record_in(json.at("record"));
    width_ = whole_in<std::size_t>(json.at("width"));
    height_ = whole_in<std::size_t>(json.at("height"));
}

PassSums CheckpointReader::read_sums() const {
    PassSums sums(width_, height_);
    Hash128 checksum{};
    std::ifstream stream(file_, std::ios::binary);
    stream.seekg(
        static_cast<std::streamoff>(kCheckpointMagic.size() + sizeof(std::uint64_t) + header_.size()));
    const auto read = [&](std::span<std::byte> bytes) {
        stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    };
    read(std::as_writable_bytes(sums.sums()));
    read(std::as_writable_bytes(sums.firsts()));
    read(std::as_writable_bytes(std::span(checksum)));
    const std::array<std::uint64_t, 1> size{header_.size()};
    if (!stream || checksum_of(parts_of(size, header_, sums)) != checksum) {
        fail_as_damaged(file_);
    }
    set_rows(record_, sums);
    return sums;
}

}  // namespace nearlight::core
