// SPDX-License-Identifier: Apache-2.0
#include "host/cli/render_command.h"

#include <optional>
#include <utility>

#include "host/base/limits.h"
#include "host/base/thread_limit.h"
#include "host/cli/interrupt.h"
#include "host/cli/mpi_options.h"
#include "host/cli/output.h"
#include "host/cli/render_frames.h"
#include "host/cli/render_help.h"
#include "host/cli/render_run.h"
#include "host/ranks/helpers.h"

namespace nearlight::core {
namespace {

/// `--preview` sets what other options stand for too. It must be added before them, because options take
/// effect in the order in which they are added, and what the user asks for by name prevails.
void add_preview_option(CLI::App& command, RenderOptions& options) {
    command.add_flag_callback(
        "--preview",
        [&options] {
            options.settings.sampling.vpl_count = 500;
            options.settings.gather.samples_per_pixel = 1;
            options.settings.gather.interleave = 4;
            options.settings.view.ray_budget_pilot = false;
            options.settings.gather.direct_samples_per_pixel = 1;
            options.settings.gather.rays_per_pixel = 1;
            options.picture.denoise_fast = true;
        },
        "A quick picture, best with --denoise: --spp 1 --vpls 500 --direct-samples 1 --rays 1, where each "
        "pixel of a square of 4x4 asks a sixteenth of the VPLs; other options prevail");
}

void add_session_options(CLI::App& command, SessionOptions& session) {
    add_choice<GatherKernel>(command, "--gather", session.gather_kernel,
                             {kGatherKernels.begin(), kGatherKernels.end()},
                             "Gather kernel: packets (for CPUs), rays (for GPUs) or auto")
        ->default_str(to_string(session.gather_kernel));
    add_bvh_option(command, session.bvh_quality);
}

/// Waits for the other ranks, which get ready as this one does, and has them help.
void enlist(Helpers& helpers, const RenderRun& run, Session& session) {
    check_ranks(helpers.wait_until_ready(), rank_facts(run));
    session.enlist(helpers.devices());
}

/// Makes one picture, together with `helpers` if there are any.
ExitCode render_once(const RenderOptions& options, const GlobalOptions& global, const DeviceChoice& choice,
                     Helpers* helpers) {
    check_outputs(options.picture);
    check_checkpoint(options.checkpoint, options.picture.outputs);
    if (!options.vpl_files.save.empty()) {
        check_is_no_output("--save-vpls", options.vpl_files.save, options.picture.outputs);
    }
    warn_of_idle_interval(options.checkpoint, settled(options));
    std::optional<CheckpointReader> reader = open_checkpoint(options.checkpoint);
    const Stopwatch total;
    RowSinks sinks(options);
    RenderRun run = get_ready(options, global, choice);
    PictureStart start{.facts = run.facts()};
    start.passes = pass_start(options.checkpoint, reader, start.facts, run.settings, run.window());
    warn_of_unsplatted_passes(run.settings, run.scene->camera.filter);
    catch_interrupts();
    Session session(run.plain_devices(), *run.scene, options.session);
    if (helpers != nullptr) {
        enlist(*helpers, run, session);
    }
    const MadePicture made = make_picture(session, run, std::move(start), sinks, total);
    if (global.json) {
        print_json(made.json);
    }
    return made.report.interrupted ? ExitCode::interrupted : ExitCode::done;
}

/// Makes one picture with the other ranks of a job, as the leading rank or as one that helps.
ExitCode render_with_ranks(const RenderOptions& options, const GlobalOptions& global,
                           const DeviceChoice& choice) {
    if (options.frames.range) {
        throw Error(
            ErrorKind::invalid_argument,
            "ranks make one picture together, but no --frames; give --mpi off and each process frames of "
            "its own");
    }
    Post post;
    if (post.rank().number > 0) {
        return help_render(options, global, choice, post);
    }
    Helpers helpers(post);
    return render_once(options, global, choice, &helpers);
}

/// A render that resumes keeps the splats of its first passes, even if --denoise or mattes are new. Every
/// rank reads that from the checkpoint, so that all of them have the same settings.
RenderOptions with_splats_of_checkpoint(RenderOptions options) {
    std::error_code error;
    if (options.splat.empty() && options.checkpoint.resumes &&
        std::filesystem::exists(options.checkpoint.file, error)) {
        const CheckpointReader reader(options.checkpoint.file);
        const auto found = reader.facts().settings.find("--splat");
        const bool is_known = found != reader.facts().settings.end() && found->is_string();
        options.splat = is_known ? found->get<std::string>() : "";
    }
    return options;
}

ExitCode run_render(const RenderOptions& asked, const GlobalOptions& global) {
    const RenderOptions options = with_splats_of_checkpoint(asked);
    check_variance_is_known(options.picture, settled(options));
    const ThreadLimit limit(options.threads);
    if (options.threads > 0) {
        limit_driver_threads(options.threads);
    }
    const DeviceChoice choice = with_compile_workers(options.device);
    if (joins_job(options.mpi)) {
        return render_with_ranks(options, global, choice);
    }
    return options.frames.range ? render_frames(options, global, choice)
                                : render_once(options, global, choice, nullptr);
}

}  // namespace

void add_render_command(CommandLine& line) {
    auto options = std::make_shared<RenderOptions>();
    CLI::App& command = line.add_command(
        "render", "Render a scene with virtual point lights", [options](const GlobalOptions& global) {
            if (options->picture.outputs.empty()) {
                options->picture.outputs = {default_output(options->scene.file)};
            }
            return run_render(*options, global);
        });
    add_preview_option(command, *options);
    options->picture.offers_mattes = true;
    add_scene_options(command, options->scene);
    add_picture_options(command, options->picture);
    add_scene_size_option(command, options->size);
    command
        .add_option_function<std::string>(
            "--crop",
            [options](const std::string& text) { options->settings.gather.window = parse_window(text); },
            "Render this part of the picture only: its size, and its place from the left and from the top, "
            "as in 320x240+100+50")
        ->type_name("WxH+X+Y");
    add_filter_option(command, options->scene.filter);
    add_glass_option(command, options->scene.clear_glass);
    add_sample_options(command, options->settings.gather, Pilot::runs);
    add_refine_option(command, options->settings.gather);
    add_splat_option(command, options->splat);
    command
        .add_option(
            "--strata", options->settings.gather.strata,
            "Divide the VPLs into N parts. Each sample asks one part, whose VPLs count N times; 1: each "
            "sample asks all (default: as many as --spp)")
        ->check(CLI::Range(1u, kMaxSamplesPerPixel))
        ->type_name("N");
    add_pass_options(command, options->passes);
    add_tev_option(command, options->tev);
    add_sampler_options(command, options->settings, options->method);
    add_vpl_options(command, options->vpl_files);
    add_checkpoint_options(command, options->checkpoint);
    add_frame_options(command, options->frames);
    add_method_options(command, options->settings, options->method, Pilot::runs);
    add_session_options(command, options->session);
    add_device_options(command, options->device);
    add_mpi_option(command, options->mpi);
    command
        .add_option("--threads", options->threads,
                    "CPU threads for reading meshes, building trees and for PoCL's CPU device (other CPU "
                    "drivers ignore this); 0: one per core")
        ->check(CLI::Range(0, 1024))
        ->type_name("N")
        ->capture_default_str();
}

}  // namespace nearlight::core
