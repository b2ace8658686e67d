#include <echinus/version.hpp>

#include <gtest/gtest.h>

#include <string>

namespace echinus {
namespace {

TEST(Version, IsOneInTheHeaderAndInTheLibrary) {
    const std::string numbers = std::to_string(ECHINUS_VERSION_MAJOR) + "." +
                                std::to_string(ECHINUS_VERSION_MINOR) + "." +
                                std::to_string(ECHINUS_VERSION_PATCH);
    EXPECT_EQ(ECHINUS_VERSION_STRING, numbers);
    EXPECT_EQ(version(), numbers);
}

} // namespace
} // namespace echinus
