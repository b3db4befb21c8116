// SPDX-License-Identifier: Apache-2.0
// --checkpoint, --resume and --first-pass, and `nearlight merge`, tried with the real program.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "host/base/files.h"
#include "host/cli/checkpoint_file.h"
#include "host/image/image_io.h"
#include "tests/cli/run_program.h"
#include "tests/cli/small_scene.h"
#include "tests/support/device_required.h"

namespace nearlight::core {
namespace {

class CheckpointsOfRender : public testing::Test {
  protected:
    CheckpointsOfRender() { std::ofstream(folder_ / "scene.xml") << floor_and_wall(); }
    void SetUp() override { NEARLIGHT_NEEDS_DEVICE(); }

    /// A command line for the picture `name`, small unless the options say otherwise.
    [[nodiscard]] std::string arguments(const std::string& name, const std::string& options) const {
        std::string line = "render --json " + quoted(folder_ / "scene.xml") + " -o " +
                           quoted(folder_ / (name + ".exr")) + " " + options;
        for (const auto& [option, value] : {std::pair{" --vpls", " 100"}, {" --spp", " 4"}}) {
            line += line.find(option) == std::string::npos ? std::string(option) + value : "";
        }
        return line;
    }
    [[nodiscard]] std::string checkpoint(const std::string& name) const {
        return "--checkpoint " + quoted(file(name)) + " ";
    }
    [[nodiscard]] std::filesystem::path file(const std::string& name) const {
        return folder_ / (name + ".sums");
    }

    /// Renders with a checkpoint of the same name, and returns the hash of the picture.
    std::string render(const std::string& name, const std::string& options) const {
        const ProgramResult result = run_program(arguments(name, checkpoint(name) + options));
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        return nlohmann::json::parse(result.output)["image_hash"];
    }
    /// The hash of a picture without a checkpoint.
    std::string plain(const std::string& options) const {
        const ProgramResult result = run_program(arguments("plain", options));
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        return nlohmann::json::parse(result.output)["image_hash"];
    }
    /// Expects one line, and an old picture that nobody touched.
    void expect_refusal(const std::string& name, const std::string& options, int exit_code,
                        const std::string& part) const {
        write_text(folder_ / "refused.exr", "old");
        const ProgramResult result = run_program(arguments("refused", checkpoint(name) + options));
        EXPECT_EQ(result.exit_code, exit_code) << options << result.errors;
        EXPECT_EQ(result.output, "") << options;
        EXPECT_TRUE(result.errors.find(part) != std::string::npos) << options << result.errors;
        EXPECT_EQ(std::ranges::count(result.errors, '\n'), 1) << result.errors;
        EXPECT_EQ(file_text(folder_ / "refused.exr"), "old");
    }
    [[nodiscard]] ProgramResult merge(const std::vector<std::string>& names, const std::string& more) const {
        std::string line = "merge --json " + more;
        for (const std::string& name : names) {
            line += " " + quoted(file(name));
        }
        return run_program(line);
    }
    void expect_no_merge(const std::vector<std::string>& names, int exit_code,
                         const std::string& part) const {
        const ProgramResult result = merge(names, "-o " + quoted(folder_ / "none.exr"));
        EXPECT_EQ(result.exit_code, exit_code) << result.errors;
        EXPECT_TRUE(result.errors.find(part) != std::string::npos) << part << ": " << result.errors;
        EXPECT_EQ(std::ranges::count(result.errors, '\n'), 1) << result.errors;
        EXPECT_FALSE(std::filesystem::exists(folder_ / "none.exr"));
    }
    /// How many files there are that somebody began to write.
    [[nodiscard]] std::size_t partial_files() const {
        std::size_t count = 0;
        for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
            count += entry.path().string().find(".partial") != std::string::npos ? 1 : 0;
        }
        return count;
    }

    TemporaryFolder folder_;
};

TEST_F(CheckpointsOfRender, AFinishedPictureIsThereAgainAndTakesMorePasses) {
    const std::string two = plain("--passes 2");
    EXPECT_EQ(render("a", "--passes 2"), two);
    const Image first = read_image(folder_ / "a.exr");
    EXPECT_EQ(render("a", "--passes 2 --resume"), two);
    EXPECT_EQ(read_image(folder_ / "a.exr").values, first.values);
    EXPECT_EQ(render("a", "--passes 4 --resume"), plain("--passes 4"));
    EXPECT_EQ(read_metadata(folder_ / "a.exr").at("nearlight:passSpp"), Metadata::mapped_type{"4*4"});
}

TEST_F(CheckpointsOfRender, OfOnePassIsThePictureWithoutOne) {
    const std::string one = plain("");
    EXPECT_EQ(render("a", "--resume"), one) << "there is nothing to go on from";
    EXPECT_EQ(render("a", "--resume"), one);
}

TEST_F(CheckpointsOfRender, OfSeveralPassesGoOnForATime) {
    render("a", "--passes 2");
    const ProgramResult result = run_program(arguments("a", checkpoint("a") + "--resume --time 0.01"));
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_GE(nlohmann::json::parse(result.output)["passes"], 2);
}

TEST_F(CheckpointsOfRender, KnowTheirKernelsFromOthers) {
    const std::filesystem::path kernels = folder_ / "kernels";
    // Tunables of a cache would belong to other kernels, which a warning says.
    const std::string own_kernels = "--cache-dir none --kernel-dir " + quoted(kernels) + " ";
    std::filesystem::copy(std::filesystem::path(NEARLIGHT_SOURCE_DIR) / "kernels", kernels,
                          std::filesystem::copy_options::recursive);
    const std::string two = render("a", "--passes 2");
    EXPECT_EQ(render("a", own_kernels + "--resume --passes 2"), two) << "they are the same kernels";
    // A file that is none of the program's own counts too.
    write_text(kernels / "more.cl", "\n");
    write_text(kernels / "film.cl", "#include \"more.cl\"\n" + file_text(kernels / "film.cl"));
    render("b", own_kernels + "--first-pass 2");
    expect_refusal("a", own_kernels + "--resume --passes 2", 3, "made it, and not");
    expect_no_merge({"a", "b"}, 3, "made it, and not");
    write_text(kernels / "more.cl", "// edited\n");
    expect_refusal("b", own_kernels + "--first-pass 2 --resume", 3, "made it, and not");
}

TEST_F(CheckpointsOfRender, AKilledRenderGoesOnToTheSameBits) {
    const std::string options = "--passes 8 --size 256x192 ";
    const std::string whole = plain(options);
    const Image expected = read_image(folder_ / "plain.exr");
    const std::string line = arguments("a", checkpoint("a") + options + "--resume --checkpoint-every 0");
    int kills = 0;
    ProgramResult result;
    // The moments spread over start, VPLs, gather and writing. Each run has a little longer than the one
    // before.
    for (double seconds = 0.15; seconds < 60; seconds *= 1.4) {
        result = run_program(line, "timeout --foreground --signal=KILL " + std::to_string(seconds));
        if (result.exit_code == 0) {
            break;
        }
        ++kills;
        // 124: the render ended by itself just when its time was up.
        ASSERT_TRUE(result.exit_code == 137 || result.exit_code == 124) << result.exit_code << result.errors;
        if (std::filesystem::exists(folder_ / "a.exr")) {
            EXPECT_EQ(read_image(folder_ / "a.exr").width, 256) << "a picture on disk is whole";
        }
    }
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_GE(kills, 3);
    EXPECT_EQ(nlohmann::json::parse(result.output)["image_hash"], whole);
    EXPECT_EQ(read_image(folder_ / "a.exr").values, expected.values);
    EXPECT_EQ(partial_files(), 0u);
}

TEST_F(CheckpointsOfRender, AnInterruptedRenderGoesOnToTheSameBits) {
    const std::string options = "--passes 8 --size 256x192 ";
    const ProgramResult stopped =
        run_interrupted(arguments("a", checkpoint("a") + options + "--resume"), 1.0,
                        [&](const ProgramResult&) { return std::filesystem::exists(file("a")); });
    ASSERT_EQ(stopped.exit_code, 130) << stopped.errors;
    EXPECT_TRUE(stopped.errors.find("from which --resume goes on") != std::string::npos) << stopped.errors;
    EXPECT_EQ(render("a", options + "--resume"), plain(options));
}

TEST_F(CheckpointsOfRender, ThePictureOnDiskImprovesPassByPass) {
    const std::string line = arguments("a", "--passes 100000 --checkpoint-every 0");
    // A slow machine needs longer for the first passes.
    for (double seconds = 2; seconds < 100 && !std::filesystem::exists(folder_ / "a.exr"); seconds *= 2) {
        const ProgramResult stopped =
            run_program(line, "timeout --foreground --signal=KILL " + std::to_string(seconds));
        ASSERT_EQ(stopped.exit_code, 137) << stopped.errors;
    }
    const int passes = std::get<int>(read_metadata(folder_ / "a.exr").at("nearlight:passes"));
    plain("--passes " + std::to_string(passes));
    EXPECT_EQ(read_image(folder_ / "a.exr").values, read_image(folder_ / "plain.exr").values);
}

TEST_F(CheckpointsOfRender, OfAnotherPictureAreRefused) {
    render("a", "--passes 2");
    expect_refusal("a", "--passes 3", 3, "is there already; go on from it with --resume");
    expect_refusal("a", "--resume --passes 1", 2, "use --passes 2");
    expect_refusal("a", "--resume --pass-spp 4,3", 2, "with which --pass-spp does not begin");
    for (const auto& [options, part] : std::vector<std::pair<std::string, std::string>>{
             {"--vpls 99", "it has --vpls 100, and not 99"},
             {"--size 65x48", "it has --size 64x48, and not 65x48"},
             {"--crop 10x10+5+5", "it has --crop none, and not 10x10+5+5"},
             {"--seed 1", "it has --seed 0, and not 1"},
             {"--first-pass 1", "it has --first-pass 0, and not 1"},
             {"--bvh fast", "it has --bvh quality, and not fast"},
             {"--environment sky", "it is of another scene"},
             {"--filter tent", "it is of another scene"}}) {
        expect_refusal("a", "--resume --passes 2 " + options, 3, part);
    }
    EXPECT_EQ(render("a", "--resume --passes 2"), plain("--passes 2")) << "it is as it was";
}

TEST_F(CheckpointsOfRender, ThatAreDamagedAreRefused) {
    render("a", "--passes 2");
    const std::string good = read_bytes(file("a"));
    const auto expect_refusal_of = [&](const std::string& bytes, const std::string& part) {
        write_text(file("b"), bytes);
        expect_refusal("b", "--resume --passes 2", 3, part);
        expect_no_merge({"b"}, 3, part);
    };
    std::string other_version = good;
    other_version[7] = '9';
    expect_refusal_of(other_version, "another version of nearlight wrote it");
    expect_refusal_of("", "it is no checkpoint");
    expect_refusal_of(file_text(folder_ / "a.exr"), "it is no checkpoint");
    for (const std::size_t size :
         {std::size_t{8}, std::size_t{12}, std::size_t{500}, good.size() / 2, good.size() - 1}) {
        expect_refusal_of(good.substr(0, size), "it is damaged or incomplete");
    }
    expect_refusal_of(good + " ", "it is damaged or incomplete");
    for (const std::size_t place :
         {std::size_t{9}, std::size_t{30}, std::size_t{700}, good.size() / 2, good.size() - 1}) {
        std::string flipped = good;
        flipped[place] = static_cast<char>(flipped[place] ^ 4);
        write_text(file("b"), flipped);
        const ProgramResult result = run_program(arguments("b", checkpoint("b") + "--resume --passes 2"));
        EXPECT_EQ(result.exit_code, 3) << place << result.errors;
        EXPECT_EQ(std::ranges::count(result.errors, '\n'), 1) << result.errors;
    }
}

TEST_F(CheckpointsOfRender, SayTheSameOfAPictureThatIsResumed) {
    const std::string options = checkpoint("a") + "--spp 16 --direct-samples 64 --pass-spp 8,16 ";
    const auto report = [&](const std::string& more) {
        return nlohmann::json::parse(run_program(arguments("a", options + more)).output);
    };
    const nlohmann::json once = report("");
    const nlohmann::json again = report("--resume");
    for (const char* name : {"image_hash", "direct_samples_per_pixel", "clamp_radius", "splat", "refine"}) {
        EXPECT_EQ(again[name], once[name]) << name;
    }
    EXPECT_EQ(once["direct_samples_per_pixel"], 64);
    EXPECT_LE(once["seconds"]["first_rows"], once["seconds"]["total"]);
}

TEST_F(CheckpointsOfRender, OptionsWithoutEffectAreTold) {
    const ProgramResult single = run_program(arguments("a", "--checkpoint-every 1"));
    EXPECT_NE(single.errors.find("--checkpoint-every changes nothing"), std::string::npos) << single.errors;
    const ProgramResult several = run_program(arguments("a", "--checkpoint-every 1 --passes 2"));
    EXPECT_EQ(several.errors.find("changes nothing"), std::string::npos) << several.errors;
    render("b", "");
    const ProgramResult merged =
        merge({"b"}, "--exposure 2 --exr-precision float --checkpoint " + quoted(file("c")));
    EXPECT_NE(merged.errors.find("--exposure and --tonemap change nothing"), std::string::npos)
        << merged.errors;
    EXPECT_NE(merged.errors.find("--exr-compression change nothing"), std::string::npos) << merged.errors;
    EXPECT_NE(merged.errors.find("wrote " + file("c").string()), std::string::npos) << merged.errors;
}

// Its header says the size of the picture, but its sums are those of a smaller one.
TEST_F(CheckpointsOfRender, WithSumsOfAnotherSizeIsRefused) {
    render("a", "--passes 2");
    const CheckpointReader reader(file("a"));
    write_checkpoint(file("b"), reader.facts(), reader.record(),
                     PassSums(reader.width(), reader.height() / 2));
    expect_refusal("b", "--resume --passes 3", 3, "it has sums of");
}

TEST_F(CheckpointsOfRender, CannotBeWhatThePictureIs) {
    const ProgramResult same = run_program(arguments("a", "--checkpoint " + quoted(folder_ / "a.exr")));
    EXPECT_EQ(same.exit_code, 2) << same.errors;
    EXPECT_EQ(run_program(arguments("a", "--resume")).exit_code, 2);
    EXPECT_EQ(run_program(arguments("a", "--checkpoint " + quoted(folder_.path()))).exit_code, 3);
    EXPECT_EQ(run_program(arguments("a", "--checkpoint " + quoted(folder_ / "no" / "c"))).exit_code, 3);
    EXPECT_EQ(run_program(arguments("a", checkpoint("a") + "--load-vpls x.ply")).exit_code, 2);
    EXPECT_EQ(run_program(arguments("a", "--first-pass 1 --save-vpls x.ply")).exit_code, 2);
    EXPECT_EQ(run_program(arguments("a", "--first-pass -1")).exit_code, 2);
    EXPECT_EQ(run_program(arguments("a", checkpoint("a") + "--checkpoint-every nan")).exit_code, 2);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a.exr"));
}

TEST_F(CheckpointsOfRender, JobsAddUpToTheBitsOfOneRender) {
    const std::string layers = "--layers depth,albedo,direct,indirect,variance ";
    const std::string whole = render("whole", layers + "--passes 6");
    render("a", "--passes 2");
    render("b", "--first-pass 2 --passes 3");
    render("c", "--first-pass 5 --error 100");
    const ProgramResult result =
        merge({"c", "a", "b"}, layers + checkpoint("all") + "-o " + quoted(folder_ / "all.exr"));
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    const nlohmann::json json = nlohmann::json::parse(result.output);
    EXPECT_EQ(json["image_hash"], whole);
    EXPECT_EQ(json["passes"], 6);
    EXPECT_EQ(json["ranges"].size(), 1u);
    const Image merged = read_image(folder_ / "all.exr");
    EXPECT_EQ(merged.channels, read_image(folder_ / "whole.exr").channels);
    EXPECT_EQ(merged.values, read_image(folder_ / "whole.exr").values);
    for (const char* name : {"nearlight:passes", "nearlight:passSpp", "nearlight:vpls", "nearlight:range",
                             "nearlight:clampRadius", "nearlight:firstPass", "nearlight:sceneHash"}) {
        EXPECT_EQ(read_metadata(folder_ / "all.exr").at(name), read_metadata(folder_ / "whole.exr").at(name))
            << name;
    }
    EXPECT_EQ(render("all", "--resume --passes 8"), render("whole", "--resume --passes 8"));
}

TEST_F(CheckpointsOfRender, JobsOfOtherSeedsAddUp) {
    render("a", "--passes 2");
    render("b", "--seed 7 --passes 1");
    const ProgramResult result = merge({"b", "a"}, checkpoint("all"));
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(nlohmann::json::parse(result.output)["ranges"].size(), 2u);
    expect_refusal("all", "--resume --passes 4", 3, "do not follow one another");
    expect_no_merge({"all", "b"}, 3, "its pass 0 with --seed 7 is in");
}

TEST_F(CheckpointsOfRender, OfJobsWithOtherBitsSayWhatWasSeveral) {
    render("a", "--passes 2 --bvh fast");
    render("b", "--first-pass 2 --gather rays");
    const ProgramResult result = merge({"a", "b"}, checkpoint("all"));
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    expect_refusal("all", "--resume --passes 4", 3, "it has --gather several, and not auto");
    const std::string header = file_text(file("all"));
    EXPECT_NE(header.find(R"("--bvh":"several")"), std::string::npos);
    EXPECT_EQ(header.find(R"("--device":"several")"), std::string::npos);
}

TEST_F(CheckpointsOfRender, JobsThatDoNotBelongTogetherAreRefused) {
    render("a", "--passes 2");
    render("fewer", "--vpls 50 --first-pass 2");
    render("other", "--environment sky --first-pass 2");
    render("again", "--first-pass 1 --passes 3");
    render("clamped", "--compensate off");
    render("clamped too", "--compensate off --seed 3");
    expect_no_merge({"a", "a"}, 3, "its pass 0 with --seed 0 is in");
    expect_no_merge({"a", "again"}, 3, "its pass 1 with --seed 0 is in");
    expect_no_merge({"a", "fewer"}, 3, "it has --vpls 50, and not 100 as '");
    expect_no_merge({"a", "other"}, 3, "it is of another scene");
    expect_no_merge({"clamped", "clamped too"}, 3, "give all jobs --range and --clamp-radius");
    expect_no_merge({"a", "missing"}, 3, "no such file");
    expect_no_merge({}, 2, "CHECKPOINT is required");
    EXPECT_EQ(merge({"a"}, "").exit_code, 2);
    const std::string same = quoted(folder_ / "x.exr");
    EXPECT_EQ(merge({"a"}, "-o " + same + " --checkpoint " + same).exit_code, 2);
    const ProgramResult lost = merge({"a"}, "--checkpoint " + quoted(folder_ / "other.sums"));
    EXPECT_EQ(lost.exit_code, 3);
    EXPECT_NE(lost.errors.find("is there already; give another file"), std::string::npos) << lost.errors;
    for (const char* const picture : {"a.exr", "a.EXR", "a.png"}) {
        const ProgramResult rounded =
            run_program("merge " + quoted(folder_ / picture) + " -o " + quoted(folder_ / "x.exr"));
        EXPECT_EQ(rounded.exit_code, 3) << picture;
        EXPECT_NE(rounded.errors.find("the numbers of pictures are rounded"), std::string::npos)
            << rounded.errors;
    }
}

}  // namespace
}  // namespace nearlight::core
