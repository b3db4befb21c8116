// SPDX-License-Identifier: Apache-2.0
// `mpirun nearlight render`, tried with the real program: pictures of several ranks, and what becomes of them
// when ranks fail, are killed or are interrupted.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <fstream>
#include <future>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "host/base/stopwatch.h"
#include "tests/cli/run_program.h"
#include "tests/cli/small_scene.h"
#include "tests/support/device_required.h"

namespace nearlight::core {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::Not;

/// A command of mpirun, to which the program and its arguments are added. It ends by itself if the ranks
/// hang.
std::string mpirun(const std::string& options) {
    return "env OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 timeout --foreground "
           "--kill-after=5 120 " NEARLIGHT_MPIRUN " --quiet --oversubscribe " +
           options;
}

/// The process of a rank of the job that renders to `output`; 0 if there is none. Processes that only compile
/// are children of a rank, so their numbers are higher.
pid_t process_of(int rank, const std::filesystem::path& output) {
    std::vector<pid_t> found;
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator("/proc", ignored)) {
        const std::string variables = file_text(entry.path() / "environ");
        const std::string words = file_text(entry.path() / "cmdline");
        if (variables.find("OMPI_COMM_WORLD_RANK=" + std::to_string(rank) + '\0') != std::string::npos &&
            words.starts_with(NEARLIGHT_PROGRAM) && words.find(output.string()) != std::string::npos) {
            found.push_back(std::stoi(entry.path().filename()));
        }
    }
    return found.empty() ? 0 : std::ranges::min(found);
}

class Ranks : public testing::Test {
  protected:
    void SetUp() override {
        NEARLIGHT_NEEDS_DEVICE();
        if (std::string_view(NEARLIGHT_MPIRUN).empty()) {
            GTEST_SKIP() << "the build found no MPI, or there is no mpirun (Debian: libopenmpi-dev)";
        }
        std::ofstream(scene()) << floor_and_wall();
    }
    [[nodiscard]] std::filesystem::path scene() const { return folder_ / "scene.xml"; }
    [[nodiscard]] std::filesystem::path file(const std::string& name) const { return folder_ / name; }
    /// The arguments of a small picture, on one thread a rank.
    [[nodiscard]] std::string arguments(const std::string& more = {}) const {
        return "render --json --threads 1 --vpls 100 --spp 2 " + quoted(scene()) + " -o " +
               quoted(file("out.exr")) + " " + more;
    }
    /// Renders, and calls `disturb` as soon as there is the file of the checkpoint.
    template <typename Disturb>
    ProgramResult render_and(Disturb disturb, const std::string& arguments, const std::string& before) const {
        auto running = std::async(std::launch::async, [&] { return run_program(arguments, before); });
        while (!std::filesystem::exists(file("out.sums")) &&
               running.wait_for(10ms) != std::future_status::ready) {}
        disturb();
        return running.get();
    }
    void signal_rank(int rank, int signal) const {
        const pid_t process = process_of(rank, file("out.exr"));
        EXPECT_GT(process, 0) << "rank " << rank;
        if (process > 0) {
            kill(process, signal);
        }
    }

  private:
    TemporaryFolder folder_;
};

/// The only JSON object on standard output.
nlohmann::json json_of(const ProgramResult& result) {
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return nlohmann::json::parse(result.output, nullptr, false);
}

/// A picture of many passes, which take longer than it takes to kill a rank.
const std::string kLongPicture = "--size 256x192 --passes 20 --rays 8 ";
const std::string kManyPasses = kLongPicture + "--checkpoint ";

/// A rank that lives says something every second, also on a machine that is very busy.
const std::string kWithRecovery = "NEARLIGHT_RANK_SILENCE=5 ";

TEST_F(Ranks, RanksTogetherGiveTheBitsOfOne) {
    for (const auto& [more, ranks] : {std::pair{"", 3u},
                                      {"--passes 3 --sampler local --crop 40x30+5+9", 2u},
                                      {"--passes 6 --error 0.03 --cuts on", 2u}}) {
        const nlohmann::json one = json_of(run_program(arguments(more)));
        const ProgramResult result = run_program(arguments(more), mpirun("-n " + std::to_string(ranks)));
        const nlohmann::json together = json_of(result);
        ASSERT_TRUE(together.is_object()) << result.output;
        EXPECT_EQ(together["image_hash"], one["image_hash"]) << more << ranks;
        EXPECT_EQ(together["passes"], one["passes"]);
        EXPECT_EQ(together["vpls"], one["vpls"]);
        EXPECT_EQ(together["device_shares"].size(), ranks);
        EXPECT_THAT(result.errors, Not(HasSubstr("warning")));
    }
}

TEST_F(Ranks, WithoutMpirunOrWithMpiOffEachProcessIsAlone) {
    EXPECT_EQ(json_of(run_program(arguments(), mpirun("-n 1")))["device_shares"].size(), 1u);
    const ProgramResult result = run_program(arguments("--quiet --mpi off"), mpirun("-n 2"));
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    const std::string hash = "\"image_hash\"";
    EXPECT_NE(result.output.find(hash), result.output.rfind(hash)) << "two objects: " << result.output;
    EXPECT_THAT(result.output, Not(HasSubstr("rank 1")));
}

/// Expects that a job ends with one line for people.
void expect_refusal(const ProgramResult& result, int exit_code, const std::string& part) {
    EXPECT_EQ(result.exit_code, exit_code) << result.errors;
    EXPECT_EQ(result.output, "");
    EXPECT_THAT(result.errors, HasSubstr(part));
    EXPECT_EQ(std::ranges::count(result.errors, '\n'), 1) << result.errors;
}

TEST_F(Ranks, ABadSceneIsSaidOnce) {
    std::ofstream(scene()) << "<scene version='3.0.0'><shape type='rectangle'></scene>";
    expect_refusal(run_program(arguments(), mpirun("-n 3")), 3, "scene.xml:1");
}

TEST_F(Ranks, ARankThatIsNotReadyEndsTheJob) {
    const std::string program = std::string(" " NEARLIGHT_PROGRAM " ");
    const std::string other = " : -n 1" + program;
    expect_refusal(run_program(arguments() + other + arguments("--device nosuch"), mpirun("-n 1")), 4,
                   "rank 1 on ");
    std::ofstream(file("other.xml")) << floor_and_wall("<default name='unused' value='1'/>") << " <";
    expect_refusal(run_program(arguments() + other + "render " + quoted(file("other.xml")), mpirun("-n 1")),
                   3, "other.xml");
}

TEST_F(Ranks, RanksThatWouldMakeOtherPicturesAreRefused) {
    const std::string other = std::string(" : -n 1 " NEARLIGHT_PROGRAM " ");
    for (const auto& [more, part] :
         {std::pair{"--seed 2", "it has --seed 2, and not 0"}, {"--light-scale 2", "it has scene "}}) {
        expect_refusal(run_program(arguments() + other + arguments(more), mpirun("-n 1")), 2, part);
    }
    std::filesystem::copy_file(NEARLIGHT_PROGRAM, file("nearlight"));
    std::ofstream(file("nearlight"), std::ios::app) << "another build";
    expect_refusal(run_program(arguments() + " : -n 1 -x LD_LIBRARY_PATH=" NEARLIGHT_BINARY_DIR "/modules " +
                                   quoted(file("nearlight")) + " " + arguments(),
                               mpirun("-n 1")),
                   2, "it has program ");
}

#ifdef NEARLIGHT_FAILING_OPENCL
TEST_F(Ranks, TheOthersDoThePartOfADeviceThatFails) {
    const std::string picture = arguments("--size 256x192 --passes 6");
    const ProgramResult result =
        run_program(picture +
                        " : -n 1 env LD_PRELOAD=" NEARLIGHT_FAILING_OPENCL
                        " NEARLIGHT_FAULT_KIND=clEnqueueNDRangeKernel NEARLIGHT_FAULT_CALL=30 " +
                        NEARLIGHT_PROGRAM + " " + picture,
                    mpirun("-n 1"));
    const nlohmann::json json = json_of(result);
    ASSERT_TRUE(json.is_object()) << result.errors;
    EXPECT_TRUE(json["device_shares"][1]["failed"].get<bool>());
    EXPECT_GT(json["device_shares"][1]["bands"].get<int>(), 0);
    EXPECT_THAT(result.errors, HasSubstr("warning: device rank 1 on "));
    EXPECT_EQ(json["image_hash"], json_of(run_program(picture))["image_hash"]);
}
#endif

TEST_F(Ranks, AfterAKilledRankTheJobIsGoneOnWith) {
    const std::string options = kManyPasses + quoted(file("out.sums")) + " --resume";
    const ProgramResult killed = render_and([&] { signal_rank(1, SIGKILL); },
                                            arguments(options + " --checkpoint-every 0.2"), mpirun("-n 2"));
    EXPECT_EQ(killed.exit_code, 137) << killed.errors;
    const nlohmann::json resumed = json_of(run_program(arguments(options), mpirun("-n 2")));
    EXPECT_EQ(resumed["image_hash"], json_of(run_program(arguments(kLongPicture)))["image_hash"]);
}

TEST_F(Ranks, WithRecoveryTheOthersDoThePartOfAKilledRank) {
    const ProgramResult result =
        render_and([&] { signal_rank(1, SIGKILL); },
                   arguments(kManyPasses + quoted(file("out.sums")) + " --checkpoint-every 0.2"),
                   kWithRecovery + mpirun("--enable-recovery -x NEARLIGHT_RANK_SILENCE -n 4"));
    EXPECT_THAT(result.errors, HasSubstr("rank 1 on "));
    const nlohmann::json json = json_of(result);
    ASSERT_TRUE(json.is_object()) << result.errors;
    EXPECT_TRUE(json["device_shares"][1]["failed"].get<bool>());
    EXPECT_FALSE(json["device_shares"][2]["failed"].get<bool>());
    EXPECT_TRUE(json["device_shares"][3]["failed"].get<bool>()) << "its pictures came through rank 1";
    EXPECT_EQ(json["image_hash"], json_of(run_program(arguments(kLongPicture)))["image_hash"]);
}

TEST_F(Ranks, ARankThatDiesWhileItsRowsAreFetchedIsLostAlone) {
    // Rank 0 sees the head of a message, whose rows it then has to fetch from a rank that is gone.
    const auto kill_while_rank_0_is_away = [&] {
        signal_rank(0, SIGSTOP);
        std::this_thread::sleep_for(2s);
        signal_rank(1, SIGKILL);
        signal_rank(0, SIGCONT);
    };
    const ProgramResult result =
        render_and(kill_while_rank_0_is_away,
                   arguments(kManyPasses + quoted(file("out.sums")) + " --checkpoint-every 0.2"),
                   kWithRecovery + mpirun("--enable-recovery -x NEARLIGHT_RANK_SILENCE -n 3"));
    const nlohmann::json json = json_of(result);
    ASSERT_TRUE(json.is_object()) << result.errors;
    EXPECT_TRUE(json["device_shares"][1]["failed"].get<bool>());
    EXPECT_FALSE(json["device_shares"][2]["failed"].get<bool>()) << result.errors;
    EXPECT_EQ(json["image_hash"], json_of(run_program(arguments(kLongPicture)))["image_hash"]);
}

TEST_F(Ranks, CtrlCEndsAllRanksAndKeepsWhatThereIs) {
    const std::string options = kManyPasses + quoted(file("out.sums")) + " --checkpoint-every 0.2";
    auto running = std::async(std::launch::async, [&] {
        return run_program(arguments(options),
                           "echo $$ >" + quoted(file("pid")) + "; exec " + mpirun("-n 3"));
    });
    while (!std::filesystem::exists(file("out.sums")) &&
           running.wait_for(10ms) != std::future_status::ready) {}
    // `timeout` passes the signal on to mpirun.
    ASSERT_EQ(kill(std::stoi(file_text(file("pid"))), SIGINT), 0);
    const ProgramResult result = running.get();
    EXPECT_NE(result.exit_code, 0);
    // What goes to standard output then may be lost on its way through mpirun.
    EXPECT_THAT(result.errors, HasSubstr("(interrupted: "));
    EXPECT_TRUE(std::filesystem::exists(file("out.exr")));
    // mpirun does not wait until the last rank is gone.
    const auto is_running = [&](int rank) { return process_of(rank, file("out.exr")) != 0; };
    const Stopwatch watch;
    while (std::ranges::any_of(std::array{0, 1, 2}, is_running) && watch.seconds() < 30.0) {
        std::this_thread::sleep_for(100ms);
    }
    EXPECT_TRUE(std::ranges::none_of(std::array{0, 1, 2}, is_running));
}

}  // namespace
}  // namespace nearlight::core
