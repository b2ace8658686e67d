#pragma once

#include "oracle/check_result.hpp"

#include <string>

/// How echinus-check prints its results.
namespace echinus::test {

std::string to_json(const CheckResult& result);
std::string to_text(const CheckResult& result);

} // namespace echinus::test
