#include "tools/command_line.hpp"

#include <cstdlib>

using MainCommand = CommandLineTest;

TEST_F(MainCommand, PrintsItsVersion) {
    EXPECT_EQ(expect_success({"--version"}), "echinus " ECHINUS_VERSION "\n");
}

TEST_F(MainCommand, TellsTheExitStatusesInItsHelp) {
    EXPECT_NE(expect_success({"--help"}).find("Exit status: 0 done, 1 failed, 2 wrong use"),
              std::string::npos);
}

TEST_F(MainCommand, RefusesAMissingOrUnknownCommandAsWrongUse) {
    expect_failure(2, "subcommand", {});
    expect_failure(2, "'frobnicate' is no command; there are mesh, info, build, query",
                   {"frobnicate", "x.obj"});
    expect_failure(2, "'frobnicate' is no command; there are mesh, map, moment, sheet",
                   {"render", "frobnicate"});
    expect_failure(2, "--frobnicate", {"--frobnicate"});
}

TEST_F(MainCommand, TellsWhereTheComparisonWentWhateverItsArguments) {
    expect_failure(2, "echinus-compare", {"compare"});
    expect_failure(2, "--target echinus-compare", {"compare", "torus.obj", "--systems", "exact,dense"});
    expect_failure(2, "echinus-compare", {"compare", "--help"});
}

TEST_F(MainCommand, SaysOnOneLineAlsoWhatAnArgumentWithNewlinesBroke) {
    expect_failure(2, "two lines", {"two\nlines"});
}

TEST_F(MainCommand, TellsOfAnInstructionSetThatTheMachineDoesNotHave) {
    setenv("ECHINUS_INSTRUCTION_SET", "abacus", 1);
    expect_failure(2, "'abacus'", {"--version"});
    setenv("ECHINUS_INSTRUCTION_SET", "scalar", 1);
    expect_success({"--version"});
    unsetenv("ECHINUS_INSTRUCTION_SET");
}
