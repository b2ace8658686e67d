#pragma once

#include "points/points.hpp"

#include <echinus/contact.hpp>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

/// Where the answers of a query go, in the order of the points, block by block. Nothing is left unless
/// finish() is reached.
class AnswerWriter {
  public:
    virtual ~AnswerWriter() = default;

    virtual void write(std::span<const echinus::Contact> contacts) = 0;
    virtual void finish() = 0;
};

/// Opens a table of `count` answers. As .npy: a structured array that numpy.load takes without pickle, its
/// fields packed: inside u1, depth f4, normal 3 f4, point 3 f4, face i4, certain u1. As .csv: a line of names
/// and one line for each answer, floats with as many digits as read back to the same bits.
/// @throws echinus::Error Unwritable
std::unique_ptr<AnswerWriter> open_answers(const std::filesystem::path& target, TableFormat format,
                                           std::uint64_t count);
