#pragma once

#include <echinus/export.hpp>

#include <stdexcept>
#include <string>

ECHINUS_EXPORT_BEGIN

namespace echinus {

/// The kind of an error, for programs; the message in Error::what() is for people.
enum class ErrorCode {
    Unreadable,         ///< a file does not exist, is a directory, or cannot be read
    Unwritable,         ///< a file cannot be written: permission, missing folder, full disk
    WrongFormat,        ///< the bytes do not have the format that the name or the reader expects
    Damaged,            ///< the file has the right format, but is truncated or contradicts itself
    UnsupportedVersion, ///< a map file of a version that this library does not read
    InvalidMesh,        ///< no faces, a coordinate that is not finite, an index out of range
    InvalidOptions,     ///< an option outside the range that its declaration states
    InvalidScene,       ///< a scene with an unknown key, a missing key or a value out of range
    Diverged,           ///< a simulation whose positions are no longer finite or have left all bounds
};

/// The exception of the offline calls (reading, building, loading, simulating). Per-particle queries do not
/// throw.
///
/// what() is one sentence without a newline. It names the file, face, byte or frame, the value that was found
/// and the one that was expected.
class Error : public std::runtime_error {
  public:
    Error(ErrorCode code, const std::string& sentence) : std::runtime_error(sentence), code_(code) {}

    ErrorCode code() const noexcept { return code_; }

  private:
    ErrorCode code_;
};

/// Called with a sentence when a call violates a precondition (`@pre`) whose check costs next to nothing: the
/// sizes of batches, and indices of colliders and particles. If the handler returns, the call returns, too,
/// without any effect. The default handler throws std::logic_error, which ends the program if the called
/// function is noexcept.
using PreconditionHandler = void (*)(const char* sentence);

/// Sets the handler for the whole program, for example one that logs or breaks into a debugger. Any thread
/// may call this at any time.
/// @param handler  null: the default
/// @return the previous handler; null: the default
PreconditionHandler set_precondition_handler(PreconditionHandler handler) noexcept;

} // namespace echinus

ECHINUS_EXPORT_END
