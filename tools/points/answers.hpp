#pragma once

#include "points/points.hpp"

#include <echinus/contact.hpp>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

/// The answers about some points. What was not asked for is empty.
struct Answers {
    std::span<const echinus::Contact> contacts = {};
    std::span<const float> signed_distances = {}, winding_numbers = {};
};

/// Which of them there are, besides contacts.
struct AnswerFields {
    bool signed_distance = false, winding_number = false;
    echinus::Vec3d origin{}; ///< of the map; where it is not 0, contact points are written as doubles
};

/// Where the answers of a query go, in the order of the points, block by block. Nothing is left unless
/// finish() is reached.
class AnswerWriter {
  public:
    virtual ~AnswerWriter() = default;

    virtual void write(const Answers& answers) = 0;
    virtual void finish() = 0;
};

/// Opens a table of `count` answers. As .npy: a structured array that numpy.load takes without pickle, its
/// fields packed: inside u1, depth f4, normal 3 f4, point 3 f4 (or 3 f8: AnswerFields::origin), face i4,
/// certain u1, and f4 for signed_distance and winding_number where they are wanted. As .csv: a line of names
/// and one line for each answer, floats with as many digits as read back to the same bits.
/// @throws echinus::Error Unwritable
std::unique_ptr<AnswerWriter> open_answers(const std::filesystem::path& target, TableFormat format,
                                           std::uint64_t count, AnswerFields fields);
