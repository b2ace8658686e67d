#pragma once

#include <string>

/// The machine and the compiler in words, for a page of measurements: nothing that identifies the computer.
std::string describe_machine();
