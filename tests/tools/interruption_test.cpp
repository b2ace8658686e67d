#include "tools/command_line.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <functional>
#include <thread>

namespace fs = std::filesystem;

namespace {

/// A cloth that takes minutes to simulate, in short frames, as it never counts as come to rest.
const std::string kLongScene = R"({"model": {"box": {"size": [1, 1, 1]}},
    "cloth": {"particles": [40, 40], "size": [3, 3], "position": [0, 0, 2]},
    "at_rest": {"frames": 100000}, "frame_limit": 100000})";
const std::string kShortScene = R"({"model": {"box": {"size": [1, 1, 1]}},
    "cloth": {"particles": [4, 3], "size": [1, 1], "position": [0, 0, 2]}, "frame_limit": 6})";

class Interruption : public CommandLineTest {
  protected:
    /// A process that runs the program in the test's folder and reads from the descriptor.
    pid_t start(const std::vector<std::string>& arguments, int input = -1) const {
        std::vector<std::string> words{ECHINUS_PROGRAM};
        words.insert(words.end(), arguments.begin(), arguments.end());
        std::vector<char*> pointers;
        for (std::string& word : words) pointers.push_back(word.data());
        pointers.push_back(nullptr);
        const pid_t child = fork();
        if (child != 0) return child;
        const int nowhere = open("/dev/null", O_RDWR);
        dup2(input >= 0 ? input : nowhere, STDIN_FILENO);
        dup2(nowhere, STDOUT_FILENO);
        if (chdir(path("").c_str()) == 0) execv(pointers[0], pointers.data());
        _exit(127);
    }

    static int end_of(pid_t child) {
        int status = 0;
        waitpid(child, &status, 0);
        return status;
    }

    static bool wait_until(const std::function<bool()>& condition) {
        for (int i = 0; i < 3000 && !condition(); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        return condition();
    }

    std::vector<std::string> parts() const {
        std::vector<std::string> names = files();
        std::erase_if(names, [](const std::string& name) { return !name.starts_with(".echinus.part"); });
        return names;
    }

    /// Starts a long simulation and waits until it writes positions.
    pid_t start_simulation() const {
        write("long.json", kLongScene);
        const pid_t child = start({"simulate", "long.json", "-o", "long", "--obj"});
        EXPECT_TRUE(wait_until([&] {
            const std::vector<std::string> names = parts();
            return !names.empty() && fs::exists(path(names.front()) / "frames" / "cloth_000001.obj");
        }));
        return child;
    }
};

} // namespace

TEST_F(Interruption, LeavesNothingBehindAndEndsByTheSignal) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        SCOPED_TRACE(strsignal(signal));
        const pid_t child = start_simulation();
        kill(child, signal);
        const int status = end_of(child);
        EXPECT_TRUE(WIFSIGNALED(status));
        EXPECT_EQ(WTERMSIG(status), signal);
        EXPECT_EQ(files(), std::vector<std::string>{"long.json"});
    }
}

TEST_F(Interruption, OfAnIgnoredSignalIsNone) {
    std::signal(SIGHUP, SIG_IGN); // as nohup does
    const pid_t child = start_simulation();
    std::signal(SIGHUP, SIG_DFL);
    kill(child, SIGHUP);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    EXPECT_EQ(waitpid(child, nullptr, WNOHANG), 0) << "it still runs";
    kill(child, SIGTERM);
    EXPECT_EQ(WTERMSIG(end_of(child)), SIGTERM);
}

TEST_F(Interruption, ByForceIsClearedByTheNextRunWhichSparesThoseThatLive) {
    const pid_t killed = start_simulation();
    kill(killed, SIGKILL);
    end_of(killed);
    ASSERT_EQ(parts().size(), 1u);
    write("short.json", kShortScene);
    expect_success({"simulate", "short.json", "-o", "short", "--json"});
    EXPECT_TRUE(parts().empty());

    const pid_t living = start_simulation();
    const std::vector<std::string> held = parts();
    expect_success({"simulate", "short.json", "-o", "short", "--json"});
    EXPECT_EQ(parts(), held);
    kill(living, SIGTERM);
    end_of(living);
}

TEST_F(Interruption, RemovesTheCopyOfStandardInput) {
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    const fs::path folder = path("tmp");
    fs::create_directory(folder);
    setenv("TMPDIR", folder.c_str(), 1);
    const auto end_by = [&](int signal) {
        const pid_t child = start({"info", "-", "--format", "obj"}, ends[0]);
        EXPECT_TRUE(wait_until([&] { return !fs::is_empty(folder); }));
        kill(child, signal);
        EXPECT_EQ(WTERMSIG(end_of(child)), signal);
    };
    end_by(SIGINT);
    EXPECT_TRUE(fs::is_empty(folder));
    end_by(SIGKILL);
    EXPECT_FALSE(fs::is_empty(folder));
    expect_success({"info", "-", "--format", "obj"}, echinus::test::box_text());
    EXPECT_TRUE(fs::is_empty(folder)) << "the next run clears what the killed one left";
    unsetenv("TMPDIR");
    close(ends[0]);
    close(ends[1]);
}

TEST_F(Interruption, FindsTheCopyOfStandardInputReadableToItsOwnerOnly) {
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    const fs::path folder = path("tmp");
    fs::create_directory(folder);
    setenv("TMPDIR", folder.c_str(), 1);
    const pid_t child = start({"info", "-", "--format", "obj"}, ends[0]);
    unsetenv("TMPDIR");
    EXPECT_TRUE(wait_until([&] { return !fs::is_empty(folder); }));
    EXPECT_EQ(fs::status(*fs::directory_iterator(folder)).permissions(), fs::perms::owner_all);
    kill(child, SIGTERM);
    end_of(child);
    close(ends[0]);
    close(ends[1]);
}

TEST_F(Interruption, IsNotNeededForInputWithoutEnd) {
    if (!fs::exists("/dev/zero")) GTEST_SKIP() << "this system has no /dev/zero";
    for (const char* name : {"zero.obj", "zero.ply", "zero.stl", "zero.csv", "zero.json"})
        fs::create_symlink("/dev/zero", path(name));
    expect_failure(1, "line 1: the line has control characters", {"info", "zero.obj"});
    expect_failure(1, "line 1: the line has control characters", {"build", "zero.ply", "-o", "map.ech"});
    expect_failure(1, "declares 0 faces in 84 bytes, but the file has more", {"info", "zero.stl"});
    expect_failure(1, "larger than 1 MB", {"simulate", "zero.json", "-o", "out"});
    write("box.obj", echinus::test::box_text());
    expect_success({"build", "box.obj", "-o", "box.ech"});
    expect_failure(1, "not a map file", {"query", "/dev/zero", "zero.csv", "-o", "a.npy"});
    expect_failure(1, "a line has more than 1048576 characters",
                   {"query", "box.ech", "zero.csv", "-o", "a.npy"});
}
