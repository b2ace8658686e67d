#pragma once

#include <echinus/error.hpp>

#include <gtest/gtest.h>

#include <string>

namespace echinus::test {

/// The call must throw an Error with this code whose sentence contains these words.
template <typename Call>
void expect_error(ErrorCode code, const std::string& words, Call&& call) {
    try {
        call();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), code) << error.what();
        EXPECT_NE(std::string(error.what()).find(words), std::string::npos)
            << "expected \"" << words << "\" in: " << error.what();
        return;
    }
    ADD_FAILURE() << "no error was thrown; expected one with \"" << words << "\"";
}

} // namespace echinus::test
