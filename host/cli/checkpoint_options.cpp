// SPDX-License-Identifier: Apache-2.0
#include "host/cli/checkpoint_options.h"

#include <algorithm>

#include "host/cli/log.h"
#include "host/cli/pass_list.h"
#include "host/cli/pass_options.h"
#include "host/cli/picture_files.h"
#include "host/session/passes.h"
#include "nearlight/error.h"

namespace nearlight::core {
namespace {

[[noreturn]] void refuse_to_go_on(const std::filesystem::path& file, const std::string& reason) {
    throw Error(ErrorKind::file, fmt::format("cannot go on from '{}': {}; give the options that it was made "
                                             "with, or another --checkpoint",
                                             file.string(), reason));
}

/// Throws Error(ErrorKind::invalid_argument) if the checkpoint has passes that the settings do not ask for.
void check_pass_count(const PassRecord& record, const std::filesystem::path& file,
                      const RenderSettings& settings) {
    const std::vector<uint>& made = record.whole.front().samples;
    const std::size_t count = made.size() + (record.begun_rows > 0 ? 1 : 0);
    const bool is_open = settings.seconds || settings.error;
    const std::vector<uint>& list = settings.pass_samples;
    const std::size_t asked = !list.empty() ? list.size() : settings.passes.value_or(is_open ? count : 1);
    if (count > asked) {
        throw Error(ErrorKind::invalid_argument,
                    fmt::format("'{}' has {} passes already, more than the {} that are asked for; use "
                                "--passes {}",
                                file.string(), count, asked, count));
    }
    std::vector<uint> begun = made;
    if (record.begun_rows > 0) {
        begun.push_back(record.begun_samples);
    }
    if (!list.empty() && !std::equal(begun.begin(), begun.end(), list.begin())) {
        throw Error(
            ErrorKind::invalid_argument,
            fmt::format("'{}' has passes of {} samples per pixel, with which --pass-spp does not begin",
                        file.string(), pass_list_text(begun)));
    }
}

void check_passes(const PassRecord& record, const std::filesystem::path& file, uint first_pass,
                  const RenderSettings& settings) {
    if (record.whole.size() > 1) {
        refuse_to_go_on(file, "`nearlight merge` made it of passes that do not follow one another");
    }
    const PassRange& range = record.whole.front();
    if (range.seed != settings.seed) {
        refuse_to_go_on(file, fmt::format("it has --seed {}, and not {}", range.seed, settings.seed));
    }
    if (range.first != first_pass) {
        refuse_to_go_on(file, fmt::format("it has --first-pass {}, and not {}", range.first, first_pass));
    }
    check_pass_count(record, file, settings);
}

}  // namespace

void add_checkpoint_options(CLI::App& command, CheckpointOptions& options) {
    auto* const file = command.add_option(
        "--checkpoint", options.file,
        "Keep the sums of all passes in this file too, for --resume and `nearlight merge`; with --spp 1, "
        "samples then lie all over their pixels, as in several passes");
    file->type_name("FILE");
    command
        .add_flag(
            "--resume", options.resumes,
            "Go on from the file of --checkpoint, to the bits of an uninterrupted render; begin anew if "
            "there is no such file")
        ->needs(file);
    command
        .add_option(
            "--checkpoint-every", options.seconds,
            "Write the checkpoint, and the picture so far after a pass, when so many seconds have "
            "passed; 0: whenever there is anything new (default: 5, but so seldom that writing takes at "
            "most a fiftieth of the time)")
        ->check(number_from(0.0, 1e9))
        ->type_name("SECONDS");
    auto* const first_pass = command.add_option(
        "--first-pass", options.first_pass,
        "Begin with this pass, counted from 0; those before it are made by other jobs, whose "
        "checkpoints `nearlight merge` adds up");
    first_pass->check(CLI::Range(0u, 1'000'000'000u))->type_name("N");
    // These VPLs are those of one pass.
    for (const char* option : {"--save-vpls", "--load-vpls"}) {
        file->excludes(command.get_option(option));
        first_pass->excludes(command.get_option(option));
    }
}

void check_checkpoint_file(const std::filesystem::path& file, const std::vector<std::string>& outputs) {
    check_is_no_output("--checkpoint", file, outputs);
    check_writable(file.string());
}

void refuse_existing_checkpoint(const std::filesystem::path& file, const char* advice) {
    std::error_code error;
    if (std::filesystem::exists(file, error)) {
        throw Error(ErrorKind::file, "the checkpoint '" + file.string() + "' is there already; " + advice);
    }
}

void check_checkpoint(const CheckpointOptions& options, const std::vector<std::string>& outputs) {
    if (options.file.empty()) {
        return;
    }
    check_checkpoint_file(options.file, outputs);
    if (!options.resumes) {
        refuse_existing_checkpoint(options.file, "go on from it with --resume, or remove it");
    }
}

void warn_of_idle_interval(const CheckpointOptions& options, const RenderSettings& settings) {
    if (options.seconds && options.file.empty() && !may_have_passes(settings)) {
        spdlog::warn("--checkpoint-every changes nothing: there is one pass, and no --checkpoint");
    }
}

std::optional<CheckpointReader> open_checkpoint(const CheckpointOptions& options) {
    std::error_code error;
    if (!options.resumes) {
        return std::nullopt;
    }
    if (!std::filesystem::exists(options.file, error)) {
        spdlog::info("there is no checkpoint '{}' yet: this is the beginning", options.file.string());
        return std::nullopt;
    }
    return CheckpointReader(options.file);
}

PassStart pass_start(const CheckpointOptions& options, std::optional<CheckpointReader>& reader,
                     const CheckpointFacts& ours, const RenderSettings& settings, const PixelWindow& window) {
    PassStart start{.first = options.first_pass, .checkpoint = {}, .keeps_sums = !options.file.empty()};
    if (reader) {
        const auto difference = difference_of_pictures(reader->facts(), ours);
        if (const auto found = difference ? difference : difference_of_bits(reader->facts(), ours)) {
            refuse_to_go_on(options.file, *found);
        }
        if (reader->width() != window.width || reader->height() != window.height) {
            refuse_to_go_on(options.file,
                            fmt::format("it has sums of {}x{} pixels, and not of {}x{}", reader->width(),
                                        reader->height(), window.width, window.height));
        }
        check_passes(reader->record(), options.file, options.first_pass, settings);
        start.checkpoint = Checkpoint{reader->record(), reader->read_sums()};
        spdlog::info(
            "going on after {} passes{}", reader->record().whole.front().samples.size(),
            reader->record().begun_rows > 0 ? fmt::format(" and {} rows", reader->record().begun_rows) : "");
    }
    return start;
}

}  // namespace nearlight::core
