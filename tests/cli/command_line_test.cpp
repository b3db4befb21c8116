// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include "host/base/shell_word.h"
#include "host/cli/command.h"
#include "tests/cli/run_program.h"
#include "tests/image/temporary_folder.h"

namespace nearlight::core {
namespace {

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// Checks that an error is one line that starts with the program's name, and that standard output is empty.
void expect_error(const ProgramResult& result, int exit_code, const std::string& part) {
    EXPECT_EQ(result.exit_code, exit_code);
    EXPECT_EQ(result.output, "");
    EXPECT_TRUE(result.errors.starts_with("nearlight: error: ")) << result.errors;
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
    EXPECT_TRUE(contains(result.errors, part)) << result.errors;
}

TEST(CommandLine, HelpAndVersion) {
    for (const char* arguments : {"--help", "-h", "diff --help", "--json diff -h"}) {
        const ProgramResult result = run_program(arguments);
        EXPECT_EQ(result.exit_code, 0) << arguments;
        EXPECT_TRUE(contains(result.output, "Usage: nearlight")) << arguments;
        EXPECT_EQ(result.errors, "") << arguments;
    }
    for (const char* arguments : {"--version", "diff --version"}) {
        const ProgramResult result = run_program(arguments);
        EXPECT_EQ(result.exit_code, 0);
        EXPECT_TRUE(result.output.starts_with("nearlight ")) << result.output;
    }
}

/// All commands, of which each has a man page, as in "bench gather"; "" stands for the program itself.
std::vector<std::string> all_commands() {
    const TemporaryFolder folder;
    EXPECT_EQ(run_program("document " + quoted(folder / ".")).exit_code, 0);
    std::vector<std::string> commands;
    for (const auto& file : std::filesystem::recursive_directory_iterator(folder / ".")) {
        if (file.path().extension() == ".1") {
            std::string name = file.path().stem().string().substr(std::string("nearlight").size());
            std::ranges::replace(name, '-', ' ');
            commands.push_back(name);
        }
    }
    return commands;
}

TEST(CommandLine, HelpFitsInAHundredColumns) {
    const std::vector<std::string> commands = all_commands();
    EXPECT_GT(commands.size(), 10u);
    for (const std::string& command : commands) {
        std::istringstream help(run_program(command + " --help").output);
        std::size_t lines = 0;
        for (std::string line; std::getline(help, line); ++lines) {
            EXPECT_LE(line.size(), 100u) << command << ": " << line;
        }
        EXPECT_GT(lines, 10u) << command;
    }
}

TEST(CommandLine, HelpShowsWhatStandsForAValue) {
    const std::string help = run_program("render --help").output;
    EXPECT_TRUE(contains(help, "--frames A[:B] "));
    EXPECT_TRUE(contains(help, "--vpls N [1000] "));
    EXPECT_TRUE(contains(help, "--denoise   "));
    EXPECT_TRUE(contains(help, " $XDG_CACHE_HOME,")) << "where kernels are kept by default";
    EXPECT_TRUE(contains(run_program("reference --help").output, "--threads N [0] "));
    EXPECT_TRUE(contains(run_program("view --help").output, " Exposure of the window and of PNG pictures,"));
    const std::string commands = run_program("--help").output;
    EXPECT_TRUE(contains(commands, "Usage: nearlight [OPTIONS] [COMMAND]\n")) << commands;
    EXPECT_TRUE(contains(commands, "\nCommands:\n  render ")) << commands;
}

TEST(CommandLine, WithoutCommandItTellsTheCommands) {
    const ProgramResult result = run_program("");
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.output, "");
    EXPECT_TRUE(contains(result.errors, "usage: nearlight COMMAND"));
    EXPECT_TRUE(contains(result.errors, "  diff "));
}

TEST(CommandLine, TyposGetSuggestions) {
    expect_error(run_program("dif a b"), 2,
                 "unknown command 'dif', did you mean 'diff'? See 'nearlight --help'");
    expect_error(run_program("diff a b --lyaer x"), 2,
                 "unknown option '--lyaer', did you mean '--layer'? See 'nearlight diff --help'");
    expect_error(run_program("diff --lyaer=x"), 2, "unknown option '--lyaer', did you mean '--layer'?");
    expect_error(run_program("render a.xml --width 64"), 2,
                 "unknown option '--width', did you mean '--size'?");
    expect_error(run_program("diff a b --width 64"), 2, "unknown option '--width'; see");
    expect_error(run_program("--jsno"), 2, "did you mean '--json'?");
    expect_error(run_program("frobnicate"), 2, "unknown command 'frobnicate'; see 'nearlight --help'");
}

TEST(CommandLine, WrongLinesAreUsageErrors) {
    expect_error(run_program("diff a"), 2, "B is required");
    expect_error(run_program("diff a b c"), 2, "unexpected argument 'c'");
    expect_error(run_program("bench"), 2,
                 "nearlight bench needs one of these commands: build, gather, sort, trace; see");
    expect_error(run_program("diff a b --layer"), 2, "--layer needs a value, ");
    expect_error(run_program("render a.xml --size"), 2,
                 "--size needs a value, WxH; see 'nearlight render --help'");
    expect_error(run_program("diff a b --quiet --verbose"), 2, "contradict");
    expect_error(run_program("render a.xml --spp 4.5"), 2,
                 "--spp: '4.5' is no whole number from 1 to 65536; see");
    expect_error(run_program("render a.xml --seed -1"), 2,
                 "--seed: '-1' is no whole number from 0 to 4294967295; see");
    expect_error(run_program("render a.xml --seed foo"), 2, "--seed: 'foo' is no whole number from 0 to");
    expect_error(run_program("render a.xml --light-scale foo"), 2, "--light-scale: 'foo' is no number; see");
    expect_error(run_program("render a.xml --fov foo"), 2, "--fov must be a number of degrees, not 'foo'");
    expect_error(run_program("render a.xml --size 8x8 --size 9x9"), 2,
                 "--size is given 2 times; give it once; see");
    expect_error(run_program("render a.xml --spp " + std::string(100000, '9')), 2, "--spp");
}

/// A script whose variable is not set gives an empty value.
TEST(CommandLine, EmptyValuesAreUsageErrors) {
    expect_error(run_program("render a.xml --camera ''"), 2,
                 "--camera is empty, but needs a value, NAME|N; see 'nearlight render --help'");
    expect_error(run_program("render a.xml --tev ''"), 2,
                 "--tev is empty, but needs a value, HOST:PORT; see");
    expect_error(run_program("view a.xml --tev ''"), 2, "--tev is empty, but needs a value, HOST:PORT; see");
    expect_error(run_program("render a.xml --exposure ''"), 2, "--exposure is empty, but needs a value");
    expect_error(run_program("render a.xml --spp ''"), 2, "--spp");
    expect_error(run_program("render a.xml -o a.png -o ''"), 2,
                 "--output is empty, but needs a value, OUT; see");
    expect_error(run_program("render ''"), 2, "SCENE is empty; see 'nearlight render --help'");
    expect_error(run_program("diff a ''"), 2, "B is empty; see 'nearlight diff --help'");
    expect_error(run_program("bench gather a.xml --dump ''"), 2,
                 "--dump is empty, but needs a value, FILE; see 'nearlight bench gather --help'");
}

TEST(CommandLine, WordsThatAnOptionTakesAreListed) {
    expect_error(run_program("render a.xml --glass foo"), 2,
                 "unknown --glass 'foo'; choose one of: refract, clear");
    expect_error(run_program("render a.xml --refine foo"), 2,
                 "unknown --refine 'foo'; choose one of: on, off");
    expect_error(run_program("render a.xml --cuts foo"), 2,
                 "unknown --cuts 'foo'; choose one of: on, off, auto");
    expect_error(run_program("render a.xml --exr-precision foo"), 2,
                 "unknown --exr-precision 'foo'; choose one of: half, float");
    expect_error(run_program("render a.xml --bvh foo"), 2,
                 "unknown --bvh 'foo'; choose one of: fast, quality");
}

TEST(CommandLine, AFileAloneGetsTheCommandThatRendersIt) {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder / "my room.glb";
    std::ofstream(file) << "model";
    expect_error(run_program(quoted(file)), 2,
                 "is a file; say what to do with it, as in: nearlight render " + shell_word(file.string()));
}

TEST(CommandLine, FullStandardOutputIsAnError) {
    if (!std::filesystem::exists("/dev/full")) {
        GTEST_SKIP() << "no /dev/full here";
    }
    const ProgramResult result = run_program("--version >/dev/full");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_TRUE(contains(result.errors, "cannot write to standard output"));
}

TEST(Size, TwoNumbersWithinBounds) {
    const ImageSize size = parse_size("640x480");
    EXPECT_EQ(size.width, 640);
    EXPECT_EQ(size.height, 480);
    EXPECT_EQ(parse_size("1x65536").height, 65536);
    for (const char* text : {"", "x", "640", "640x", "x480", "0x1", "1x0", "-1x5", "65537x1", "1x65537",
                             "640 x480", "640x480x1", "640X480", "6.5x4", "99999999999x1", "640x480 "}) {
        EXPECT_THROW(parse_size(text), Error) << text;
    }
}

}  // namespace
}  // namespace nearlight::core
