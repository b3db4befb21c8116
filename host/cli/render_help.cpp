// SPDX-License-Identifier: Apache-2.0
#include "host/cli/render_help.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <new>
#include <optional>

#include "host/base/files.h"
#include "host/base/hash.h"
#include "host/base/message.h"
#include "host/cli/checkpoint_facts.h"
#include "host/cli/interrupt.h"
#include "host/cli/log.h"
#include "host/ranks/service.h"

namespace nearlight::core {
namespace {

/// A hash of the running program, since two builds of one version may differ.
std::string program_hash() {
    return hex_digits(hash64(read_bytes("/proc/self/exe")));
}

/// Keeps warnings back until it is known which of them the leading rank says too.
class KeptWarnings {
  public:
    explicit KeptWarnings(std::string rank) : rank_(std::move(rank)) {
        set_message_sink([this](MessageLevel level, std::string_view text) {
            if (level == MessageLevel::warning) {
                texts_.emplace_back(text);
            } else {
                show_message(level, text, rank_);
            }
        });
    }
    ~KeptWarnings() { go_on(); }
    KeptWarnings(const KeptWarnings&) = delete;
    KeptWarnings& operator=(const KeptWarnings&) = delete;

    /// Says the warnings that are not among the notes of the scene, and from now on all at once.
    void say_all_but(const std::vector<Note>& notes) {
        go_on();
        for (const std::string& text : texts_) {
            if (std::ranges::find(notes, text, [](const Note& note) { return to_string(note); }) ==
                notes.end()) {
                show_message(MessageLevel::warning, text, rank_);
            }
        }
    }

  private:
    void go_on() {
        set_message_sink(
            [rank = rank_](MessageLevel level, std::string_view text) { show_message(level, text, rank); });
    }

    std::string rank_;
    std::vector<std::string> texts_;
};

}  // namespace

std::string rank_facts(const RenderRun& run) {
    const CheckpointFacts facts =
        checkpoint_facts(*run.scene, run.hash.get(), run.settings, run.options.session, run.devices);
    nlohmann::ordered_json all{{"program", program_hash() + ", version " + facts.version},
                               {"scene", hex_digits(facts.scene_hash)}};
    all.update(facts.settings);
    all.update(facts.maker);
    all.erase("--device");  // any device may help
    all["--seed"] = run.settings.seed;
    all["--first-pass"] = run.options.checkpoint.first_pass;
    all["--output"] = fmt::format("{}", fmt::join(run.options.picture.outputs, ", "));
    return all.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void check_ranks(const std::vector<Hello>& hellos, const std::string& ours) {
    for (std::size_t i = 0; i < hellos.size(); ++i) {
        const auto difference = first_difference(nlohmann::ordered_json::parse(hellos[i].facts),
                                                 nlohmann::ordered_json::parse(ours));
        if (difference) {
            throw Error(
                ErrorKind::invalid_argument,
                fmt::format(
                    "rank {} on {} would make another picture than rank 0: {}; give all ranks the same "
                    "program, files and options, or use --mpi off for a picture of each",
                    i + 1, hellos[i].host, *difference));
        }
    }
}

ExitCode help_render(const RenderOptions& options, const GlobalOptions& global, const DeviceChoice& choice,
                     Post& post) {
    Service service(post);
    KeptWarnings warnings(fmt::format("rank {} on {}", post.rank().number, post.rank().host));
    const spdlog::level::level_enum level = spdlog::get_level();
    std::optional<RenderRun> run;
    std::optional<Session> session;
    std::string facts;
    try {
        spdlog::set_level(spdlog::level::err);  // the leading rank says what is to be said of the request
        run.emplace(get_ready(options, global, choice));
        spdlog::set_level(level);
        warnings.say_all_but(run->scene->notes);
        session.emplace(run->plain_devices(), *run->scene, options.session);
        facts = rank_facts(*run);
    } catch (const Error& error) {
        service.refuse(error);
        return ExitCode::done;
    } catch (const std::bad_alloc&) {
        service.refuse(Error(ErrorKind::out_of_memory, "out of memory on the host"));
        return ExitCode::done;
    } catch (const std::exception& error) {
        service.refuse(Error(ErrorKind::failure, error.what()));
        return ExitCode::done;
    }
    catch_interrupts();  // what is to be done then, the leading rank decides
    service.run(*session, facts);
    return ExitCode::done;
}

}  // namespace nearlight::core
