// SPDX-License-Identifier: Apache-2.0
#include "host/cli/vpl_options.h"

#include "host/cli/log.h"
#include "host/cli/picture_files.h"
#include "host/session/passes.h"
#include "nearlight/error.h"

namespace nearlight::core {

void add_vpl_options(CLI::App& command, VplFiles& files) {
    command
        .add_option("--save-vpls", files.save,
                    "Write the VPLs to this PLY file, for --load-vpls and for other programs")
        ->type_name("FILE");
    CLI::Option* const load =
        command
            .add_option(
                "--load-vpls", files.load,
                "Take the VPLs of this PLY file instead of making some, as for another camera in the same "
                "scene; excludes the options that say how VPLs are made")
            ->type_name("FILE");
    for (const char* option :
         {"--sampler", "--policy", "--vpls", "--cuts", "--vpl-set", "--close-fraction"}) {
        load->excludes(command.get_option(option));
    }
}

void settle(const VplFiles& files, RenderSettings& settings) {
    settings.sampling.file = files.load;
    if (!files.save.empty() && may_have_passes(settings)) {
        throw Error(
            ErrorKind::invalid_argument,
            "--save-vpls needs a picture of one pass, because each pass has VPLs of its own; leave out "
            "--passes, --pass-spp, --time and --error");
    }
    if (!files.load.empty() && may_have_passes(settings)) {
        throw Error(
            ErrorKind::invalid_argument,
            "--load-vpls needs a picture of one pass, because its VPLs would be the same in each; leave "
            "out --passes, --pass-spp, --time and --error");
    }
    if (!files.save.empty()) {
        check_writable(files.save.string());
    }
}

void save(const VplFiles& files, Session& session, const View& view, const VplSet& vpls) {
    if (!files.save.empty()) {
        session.save_vpls(view, vpls, files.save);
        spdlog::info("wrote {} VPLs to {}", vpls.vpls.count(), files.save.string());
    }
}

}  // namespace nearlight::core
