// SPDX-License-Identifier: Apache-2.0
// Man pages and completions of the program as it is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <set>
#include <sstream>

#include "host/cli/command.h"
#include "host/cli/completions.h"
#include "host/cli/man_pages.h"
#include "tests/cli/run_program.h"

namespace nearlight::core {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsSupersetOf;
using testing::Not;

/// A program with what completions and pages must cope with.
CommandFacts small_program() {
    CLI::App app("Does little", "small");
    CLI::App& part = *app.add_subcommand("part", "A part; it's small");
    static std::string text;
    static bool flag = false;
    const std::map<std::string, bool> modes{{"fast", true}, {"slow", false}};
    add_choice(part, "--mode", flag, modes, "How to go, quickly or not")->default_str("fast");
    const std::map<std::string, int> numbers{{"one", 1}, {"two", 2}};
    static int number = 1;
    part.add_option("--number", number, "A number")
        ->transform(CLI::CheckedTransformer(numbers))
        ->type_name("NAME");
    part.add_option("--other", text, "Any name (default: fast)")->type_name("NAME");
    part.add_option("--switch", text, "On [or] off")
        ->check(CLI::IsMember({"on", "off"}))
        ->type_name("on|off");
    part.add_option("--light", text, "Light")->type_name("FILE|sky|COLOR");
    part.add_option("-o,--output", text, "A file (with a back\\slash)")->type_name("OUT")->required();
    part.add_flag("--flag", flag, ".begins with a dot");
    part.add_option("SCENE", text, "A scene")->required();
    app.add_subcommand("hidden", "Not to be seen")->group("");
    return command_facts(app);
}

TEST(CommandFacts, AreThoseOfTheParser) {
    const CommandFacts program = small_program();
    ASSERT_EQ(program.parts.size(), 1u);
    const CommandFacts& part = program.parts.front();
    EXPECT_EQ(part.full_name, "small part");
    std::map<std::string, OptionFacts> options;
    for (const OptionFacts& option : part.options) {
        options[option.names.back()] = option;
    }
    EXPECT_THAT(options["--mode"].choices, ElementsAre("fast", "slow"));
    EXPECT_EQ(options["--mode"].default_value, "fast");
    EXPECT_EQ(options["--mode"].value, "NAME");
    EXPECT_THAT(options["--other"].choices, IsEmpty());
    EXPECT_THAT(options["--number"].choices, ElementsAre("one", "two"));
    EXPECT_THAT(options["--switch"].choices, ElementsAre("on", "off"));
    EXPECT_EQ(options["--switch"].value, "on|off");
    EXPECT_THAT(options["--light"].choices, ElementsAre("sky"));
    EXPECT_TRUE(options["--light"].takes_file);
    EXPECT_FALSE(options["--switch"].takes_file);
    EXPECT_THAT(options["--output"].names, ElementsAre("-o", "--output"));
    EXPECT_TRUE(options["--output"].takes_file);
    EXPECT_TRUE(options["--output"].is_required);
    EXPECT_TRUE(options["--flag"].is_flag());
    EXPECT_TRUE(options["SCENE"].is_positional);
}

TEST(ManPages, EscapeWhatHasAMeaningThere) {
    const std::vector<ManPage> pages = man_pages(small_program(), "1.2");
    ASSERT_EQ(pages.size(), 2u);
    EXPECT_EQ(pages[0].file, "small.1");
    EXPECT_THAT(pages[0].text, HasSubstr(".BR small\\-part (1)\n"));
    EXPECT_THAT(pages[0].text, Not(HasSubstr("hidden")));
    EXPECT_EQ(pages[1].file, "small-part.1");
    EXPECT_THAT(pages[1].text,
                HasSubstr("\\fB\\-o\\fR, \\fB\\-\\-output\\fR \\fIOUT\\fR\nA file (with a back\\eslash)\n"));
    EXPECT_THAT(pages[1].text, HasSubstr("\n\\&.begins with a dot\n"));
}

/// The files that the real program writes.
class Documents : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        folder_.emplace();
        ASSERT_EQ(run_program("document " + quoted(folder())).exit_code, 0);
    }
    static void TearDownTestSuite() { folder_.reset(); }
    static std::filesystem::path folder() { return *folder_ / "documents"; }
    static bool has(const std::string& program) {
        return std::system(("command -v " + program + " >/dev/null").c_str()) == 0;
    }
    /// Expects that the command succeeds and says nothing.
    static void expect_silence(const std::string& command) {
        const TemporaryFolder scratch;
        const std::string out = (scratch / "out").string();
        EXPECT_EQ(std::system((command + " >" + out + " 2>&1").c_str()), 0) << command;
        EXPECT_EQ(file_text(out), "") << command;
    }

    /// What bash offers for the last of these words.
    static std::set<std::string> bash_offers(const std::string& words) {
        const TemporaryFolder scratch;
        std::ofstream(scratch / "ask.bash")
            << "source " << quoted(folder() / "nearlight.bash") << "\ncd " << quoted(folder().parent_path())
            << "\nCOMP_WORDS=(" << words << ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_nearlight\n"
            << "printf '%s\\n' \"${COMPREPLY[@]}\"\n";
        const std::string out = (scratch / "out").string();
        EXPECT_EQ(std::system(("bash " + (scratch / "ask.bash").string() + " >" + out + " 2>&1").c_str()), 0);
        std::istringstream lines(file_text(out));
        std::set<std::string> offers;
        for (std::string line; std::getline(lines, line);) {
            offers.insert(line);
        }
        return offers;
    }

  private:
    static std::optional<TemporaryFolder> folder_;
};
std::optional<TemporaryFolder> Documents::folder_;

TEST_F(Documents, AreNotInTheHelp) {
    EXPECT_THAT(run_program("--help").output, Not(HasSubstr("document")));
    EXPECT_THAT(run_program("").errors, Not(HasSubstr("document")));
}

TEST_F(Documents, NameEveryOptionOfTheHelp) {
    const std::string help = run_program("render --help").output;
    const std::string page = file_text(folder() / "man/nearlight-render.1");
    const std::string bash = file_text(folder() / "nearlight.bash");
    const std::string zsh = file_text(folder() / "_nearlight");
    const std::string fish = file_text(folder() / "nearlight.fish");
    std::istringstream lines(help);
    int count = 0;
    for (std::string line; std::getline(lines, line);) {
        const std::size_t first = line.find("  -") == 0 ? line.find("--") : std::string::npos;
        if (first == std::string::npos) {
            continue;
        }
        const std::string name = line.substr(first + 2, line.find_first_of(" ,", first) - first - 2);
        std::string in_man = name;
        for (std::size_t dash = 0; (dash = in_man.find('-', dash)) != std::string::npos; dash += 2) {
            in_man.replace(dash, 1, "\\-");
        }
        EXPECT_THAT(page, HasSubstr("\\fB\\-\\-" + in_man + "\\fR"));
        EXPECT_THAT(bash, HasSubstr("--" + name));
        EXPECT_THAT(zsh, HasSubstr("--" + name + "["));
        EXPECT_THAT(fish, HasSubstr(" -l " + name + " "));
        ++count;
    }
    EXPECT_GT(count, 30);
}

TEST_F(Documents, BashCompletes) {
    if (!has("bash")) {
        GTEST_SKIP() << "no bash";
    }
    std::ofstream(folder().parent_path() / "scene.xml") << "";
    EXPECT_THAT(bash_offers("nearlight ''"), IsSupersetOf({"render", "reference", "compare", "bench"}));
    EXPECT_THAT(bash_offers("nearlight re"), ElementsAre("reference", "render"));
    EXPECT_THAT(bash_offers("nearlight bench ''"), ElementsAre("build", "gather", "sort", "trace"));
    EXPECT_THAT(bash_offers("nearlight render --vp"), ElementsAre("--vpl-keys", "--vpl-set", "--vpls"));
    EXPECT_THAT(bash_offers("nearlight render --compensate ''"), ElementsAre("off", "on"));
    EXPECT_THAT(bash_offers("nearlight render --sampler m"), ElementsAre("metropolis"));
    EXPECT_THAT(bash_offers("nearlight render --tonemap ''"),
                ElementsAre("agx", "filmic", "linear", "neutral"));
    EXPECT_THAT(bash_offers("nearlight render --exr-compression d"), ElementsAre("dwaa"));
    EXPECT_THAT(bash_offers("nearlight render sce"), ElementsAre("scene.xml"));
    EXPECT_THAT(bash_offers("nearlight render -o sce"), ElementsAre("scene.xml"));
    EXPECT_THAT(bash_offers("nearlight render --environment s"), ElementsAre("scene.xml", "sky"));
    EXPECT_THAT(bash_offers("nearlight --json info sce"), ElementsAre("scene.xml"));
    EXPECT_THAT(bash_offers("nearlight render --seed ''"), ElementsAre(""));
}

TEST_F(Documents, ZshReadsThem) {
    if (!has("zsh")) {
        GTEST_SKIP() << "no zsh (Debian's zsh)";
    }
    expect_silence("zsh -n " + quoted(folder() / "_nearlight"));
}

TEST_F(Documents, FishCompletes) {
    if (!has("fish")) {
        GTEST_SKIP() << "no fish (Debian's fish)";
    }
    const std::string source = "fish -c 'source '" + quoted(folder() / "nearlight.fish");
    expect_silence(source);
    const TemporaryFolder scratch;
    std::ofstream(scratch / "scene.xml") << "";
    const std::string out = (scratch / "out").string();
    ASSERT_EQ(std::system(("cd " + quoted(scratch / ".") + " && " + source +
                           "'; complete -C \"nearlight render --environment s\"' >" + out)
                              .c_str()),
              0);
    EXPECT_THAT(file_text(out), HasSubstr("sky\t"));
    EXPECT_THAT(file_text(out), HasSubstr("scene.xml"));
}

TEST_F(Documents, ManReadsThem) {
    if (!has("groff")) {
        GTEST_SKIP() << "no groff (Debian's groff-base)";
    }
    for (const auto& page : std::filesystem::directory_iterator(folder() / "man")) {
        expect_silence("groff -man -Tutf8 -ww -z " + quoted(page.path()));
    }
}

}  // namespace
}  // namespace nearlight::core
