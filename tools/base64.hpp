#pragma once

#include <cstdint>
#include <span>
#include <string>

/// Bytes as text for an HTML document: RFC 4648, section 4.
std::string base64(std::span<const std::uint8_t> bytes);
