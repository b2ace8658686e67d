#include "cli/command_line.hpp"

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
    expect_failure(2, "frobnicate", {"frobnicate"});
    expect_failure(2, "--frobnicate", {"--frobnicate"});
}

TEST_F(MainCommand, SaysOnOneLineAlsoWhatAnArgumentWithNewlinesBroke) {
    expect_failure(2, "two lines", {"two\nlines"});
}
