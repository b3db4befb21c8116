// SPDX-License-Identifier: Apache-2.0
#include "host/cli/merge_command.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/base/files.h"
#include "host/base/hash.h"
#include "host/base/stopwatch.h"
#include "host/base/words.h"
#include "host/cli/checkpoint_facts.h"
#include "host/cli/checkpoint_file.h"
#include "host/cli/checkpoint_options.h"
#include "host/cli/log.h"
#include "host/cli/output.h"
#include "host/cli/pass_list.h"
#include "host/cli/pass_options.h"
#include "host/cli/picture_files.h"
#include "host/cli/render_output.h"
#include "host/cli/rendered_picture.h"
#include "host/session/pass_average.h"
#include "host/session/passes.h"
#include "host/session/render.h"

namespace nearlight::core {
namespace {

namespace fs = std::filesystem;

struct MergeOptions {
    std::vector<fs::path> files;
    PictureOptions picture;
    fs::path checkpoint;
};

/// What all files are together.
struct Merged {
    CheckpointFacts facts;
    PassRecord record;
    PassAverage average;
};

[[noreturn]] void refuse_to_merge(const fs::path& file, const std::string& reason) {
    throw Error(ErrorKind::file, fmt::format("cannot merge '{}': {}", file.string(), reason));
}

void check_merge_options(const MergeOptions& options) {
    if (options.picture.outputs.empty() && options.checkpoint.empty()) {
        throw Error(ErrorKind::invalid_argument,
                    "there is nothing to write; give -o OUT or --checkpoint FILE");
    }
    check_outputs(options.picture);
    if (!options.checkpoint.empty()) {
        check_checkpoint_file(options.checkpoint, options.picture.outputs);
        refuse_existing_checkpoint(options.checkpoint, "give another file, or remove it");
    }
}

CheckpointReader open_part(const fs::path& file) {
    if (const std::string extension = lower_case_extension(file);
        extension == ".exr" || extension == ".png") {
        refuse_to_merge(file, "the numbers of pictures are rounded; give the files of --checkpoint");
    }
    return CheckpointReader(file);
}

/// Throws Error(ErrorKind::file) unless the passes of `part` are whole, and have the mean of those of
/// `first`.
void check_part(const CheckpointReader& part, const CheckpointReader& first) {
    const PassRecord& record = part.record();
    if (record.begun_rows > 0 || record.whole.front().samples.empty()) {
        refuse_to_merge(part.file(),
                        "its last pass is incomplete; finish it with `nearlight render --resume`");
    }
    if (const auto difference = difference_of_pictures(part.facts(), first.facts())) {
        refuse_to_merge(part.file(), fmt::format("{} as '{}'", *difference, first.file().string()));
    }
    if (part.width() != first.width() || part.height() != first.height()) {
        refuse_to_merge(part.file(), fmt::format("it has another size than '{}'", first.file().string()));
    }
    if (record.choice != first.record().choice && mean_depends_on_choice(first.facts())) {
        refuse_to_merge(part.file(),
                        fmt::format("its range or clamp radius is not that of '{}'; give all jobs "
                                    "--range and --clamp-radius",
                                    first.file().string()));
    }
}

/// A range of passes and the file that has it.
struct OwnedRange {
    PassRange range;
    const CheckpointReader* owner = nullptr;
};

/// All ranges by their seeds and numbers. Throws Error(ErrorKind::file) if two of them have a pass in common.
std::vector<OwnedRange> sorted_ranges(const std::vector<CheckpointReader>& parts) {
    std::vector<OwnedRange> ranges;
    for (const CheckpointReader& part : parts) {
        for (const PassRange& range : part.record().whole) {
            ranges.push_back({range, &part});
        }
    }
    std::ranges::stable_sort(
        ranges, {}, [](const OwnedRange& owned) { return std::pair(owned.range.seed, owned.range.first); });
    for (std::size_t i = 1; i < ranges.size(); ++i) {
        const auto& [before, owner] = ranges[i - 1];
        const PassRange& range = ranges[i].range;
        if (range.seed == before.seed && range.first < before.end()) {
            refuse_to_merge(ranges[i].owner->file(),
                            fmt::format("its pass {} with --seed {} is in '{}' too", range.first, range.seed,
                                        owner->file().string()));
        }
    }
    return ranges;
}

/// Ranges that follow one another become one.
std::vector<PassRange> joined_ranges(const std::vector<OwnedRange>& sorted) {
    std::vector<PassRange> result;
    for (const auto& [range, owner] : sorted) {
        if (!result.empty() && result.back().seed == range.seed && result.back().end() == range.first) {
            result.back().samples.insert(result.back().samples.end(), range.samples.begin(),
                                         range.samples.end());
        } else {
            result.push_back(range);
        }
    }
    return result;
}

void add_totals(const PassTotals& part, PassTotals& sum) {
    sum.close_vpls += part.close_vpls;
    sum.distant_vpls += part.distant_vpls;
    sum.sparse_vpls += part.sparse_vpls;
    sum.candidates += part.candidates;
    sum.local_lights += part.local_lights;
}

/// The layers that are not averaged come from the first pass, so the file that has it is the first to be
/// read; the order of the others makes no difference.
Merged merge_parts(const std::vector<CheckpointReader>& parts) {
    const std::vector<OwnedRange> ranges = sorted_ranges(parts);
    const CheckpointReader& first = *ranges.front().owner;
    CheckpointFacts facts = first.facts();
    PassRecord record = first.record();
    PassSums sums = first.read_sums();
    for (const CheckpointReader& part : parts) {
        if (&part == &first) {
            continue;
        }
        sums.add(part.read_sums());
        add_totals(part.record().totals, record.totals);
        mark_differences_of_bits(part.facts(), facts);
    }
    record.whole = joined_ranges(ranges);
    return {std::move(facts), std::move(record), PassAverage(std::move(sums))};
}

std::vector<uint> all_samples(const PassRecord& record) {
    std::vector<uint> samples;
    for (const PassRange& range : record.whole) {
        samples.insert(samples.end(), range.samples.begin(), range.samples.end());
    }
    return samples;
}

/// Ranges as text, such as "seed 0: 0-7, seed 5: 0-3".
std::string ranges_text(const PassRecord& record) {
    return joined(record.whole, ", ", [](const PassRange& range) {
        return fmt::format("seed {}: {}-{}", range.seed, range.first, range.end() - 1);
    });
}

/// The relative error, if the passes tell it.
std::optional<double> error_of(const Merged& merged) {
    return tells_error(all_samples(merged.record)) ? std::optional(merged.average.error()) : std::nullopt;
}

/// The attributes of the picture's files: those of the first part, where the passes make no difference.
Metadata merged_metadata(const Merged& merged, std::optional<double> error, const std::string& command_line) {
    Metadata metadata = merged.facts.metadata;
    const PassRecord& record = merged.record;
    const std::vector<uint> samples = all_samples(record);
    metadata["nearlight:passes"] = static_cast<int>(samples.size());
    metadata["nearlight:passSpp"] = pass_list_text(samples);
    metadata["nearlight:passRanges"] = ranges_text(record);
    metadata["nearlight:firstPass"] = static_cast<int>(record.whole.front().first);
    metadata["nearlight:seed"] = count_value(record.whole.front().seed);
    metadata["nearlight:vpls"] = count_value(record.totals.close_vpls + record.totals.distant_vpls);
    metadata.erase("nearlight:error");
    if (error) {
        metadata["nearlight:error"] = static_cast<float>(*error);
    }
    metadata["nearlight:commandLine"] = command_line;
    return metadata;
}

/// Writes the pictures, and returns their hash.
std::uint64_t write_pictures(const MergeOptions& options, const Merged& merged, const Metadata& metadata) {
    const Stopwatch watch;
    RenderedPicture picture(options.picture, 0);
    const PassSums& sums = merged.average.sums();
    picture.open(static_cast<int>(sums.width()), static_cast<int>(sums.height()), metadata,
                 chosen_look(options.picture.screen, merged.facts.look), merged.facts.place);
    Hasher hasher;
    merged.average.send([&](std::span<const float> rows) {
        add_beauty(rows, hasher);
        picture.add_rows(rows);
    });
    picture.commit(watch, all_samples(merged.record));
    return hasher.hash64();
}

nlohmann::ordered_json merge_json(const MergeOptions& options, const Merged& merged,
                                  std::optional<double> error, std::uint64_t hash) {
    nlohmann::ordered_json json;
    json["inputs"] = nlohmann::ordered_json::array();
    for (const fs::path& file : options.files) {
        json["inputs"].push_back(file.string());
    }
    json["width"] = merged.average.sums().width();
    json["height"] = merged.average.sums().height();
    json["passes"] = all_samples(merged.record).size();
    json["ranges"] = nlohmann::ordered_json::array();
    for (const PassRange& range : merged.record.whole) {
        json["ranges"].push_back({{"seed", range.seed},
                                  {"first_pass", range.first},
                                  {"passes", range.samples.size()},
                                  {"pass_spp", pass_list_text(range.samples)}});
    }
    json["relative_error"] = error ? nlohmann::ordered_json(*error) : nullptr;
    json["outputs"] = options.picture.outputs;
    json["checkpoint"] =
        options.checkpoint.empty() ? nullptr : nlohmann::ordered_json(options.checkpoint.string());
    json["image_hash"] = hex_digits(hash);
    return json;
}

ExitCode run_merge(const MergeOptions& options, const GlobalOptions& global) {
    check_merge_options(options);
    std::vector<CheckpointReader> parts;
    for (const fs::path& file : options.files) {
        parts.push_back(open_part(file));
        check_part(parts.back(), parts.front());
    }
    Merged merged = merge_parts(parts);
    const std::optional<double> error = error_of(merged);
    warn_of_unknown_variance(options.picture, all_samples(merged.record));
    merged.facts.metadata = merged_metadata(merged, error, global.command_line);
    const std::uint64_t hash = write_pictures(options, merged, merged.facts.metadata);
    if (!options.checkpoint.empty()) {
        write_checkpoint(options.checkpoint, merged.facts, merged.record, merged.average.sums());
    }
    if (global.json) {
        print_json(merge_json(options, merged, error, hash));
    }
    spdlog::info("{} passes of {} file{}{}", all_samples(merged.record).size(), parts.size(),
                 parts.size() == 1 ? "" : "s", error ? fmt::format(", error {:.4f}", *error) : "");
    for (const std::string& output : options.picture.outputs) {
        spdlog::info("wrote {}", output);
    }
    if (!options.checkpoint.empty()) {
        spdlog::info("wrote {}", options.checkpoint.string());
    }
    return ExitCode::done;
}

}  // namespace

void add_merge_command(CommandLine& line) {
    auto options = std::make_shared<MergeOptions>();
    CLI::App& command =
        line.add_command("merge", "Add up the passes of jobs that worked on one picture, exactly",
                         [options](const GlobalOptions& global) { return run_merge(*options, global); });
    command
        .add_option(
            "CHECKPOINT", options->files,
            "Files of `nearlight render --checkpoint`, of the same scene and settings, with passes that "
            "only one of them has (--first-pass) or with other seeds")
        ->required();
    add_picture_options(command, options->picture);
    command.get_option("--output")
        ->description(
            "Picture to write: .exr (all layers) or .png (tone-mapped); may be given several times");
    command
        .add_option("--checkpoint", options->checkpoint,
                    "Write the sums of all passes to this file, for another `merge` or for --resume")
        ->type_name("FILE");
}

}  // namespace nearlight::core
