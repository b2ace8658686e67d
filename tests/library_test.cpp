#include "support/expectations.hpp"
#include "support/instruction_sets.hpp"

#include <echinus/error.hpp>
#include <echinus/version.hpp>

#include <gtest/gtest.h>

#include <string>

using namespace echinus;

TEST(Version, IsOneInTheHeaderAndInTheLibrary) {
    const std::string numbers = std::to_string(ECHINUS_VERSION_MAJOR) + "." +
                                std::to_string(ECHINUS_VERSION_MINOR) + "." +
                                std::to_string(ECHINUS_VERSION_PATCH);
    EXPECT_EQ(ECHINUS_VERSION_STRING, numbers);
    EXPECT_EQ(version(), numbers);
}

TEST(InstructionSet, EndsTheListWithTheReference) {
    ASSERT_FALSE(available_instruction_sets().empty());
    EXPECT_EQ(available_instruction_sets().back(), "scalar");
}

TEST(InstructionSet, IsTheOneThatWasAskedFor) {
    test::under_each_instruction_set([](std::string_view name) { EXPECT_EQ(instruction_set(), name); });
}

TEST(InstructionSet, RefusesAnUnknownNameAndTellsWhatThereIs) {
    const std::string_view before = instruction_set();
    for (const char* words : {"'abacus'", "scalar"})
        test::expect_error(ErrorCode::InvalidOptions, words, [] { use_instruction_set("abacus"); });
    EXPECT_EQ(instruction_set(), before);
}
