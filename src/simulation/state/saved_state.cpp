// The bytes of a saved state: a header, which identifies the format and the simulation, and the output of
// Solver::archive().

#include "files/atomic_file.hpp"
#include "files/read_file.hpp"
#include "simulation/solver.hpp"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <array>
#include <cstring>
#include <string>

namespace echinus {

namespace {

constexpr std::array<char, 8> kMagic{'E', 'C', 'H', 'S', 'T', 'A', 'T', 'E'};
/// To be increased with every change of what is archived or of what is derived from it.
constexpr std::uint64_t kVersion = 12;

/// Plain numbers without padding, in the byte order of the machine.
struct Header {
    std::array<char, 8> magic = kMagic;
    std::uint64_t version = kVersion;
    std::uint64_t byte_count = 0; ///< after the header
    std::uint64_t checksum = 0;   ///< XXH64 of these bytes
};

void archive(StateArchive& state, StateFingerprint& fingerprint) {
    state.value(fingerprint.options);
    state.value(fingerprint.deformable);
    state.list(fingerprint.colliders);
}

/// @return the bytes after the header
std::span<const std::byte> checked(std::span<const std::byte> bytes, const std::string& name) {
    Header header;
    if (bytes.size() >= sizeof header) std::memcpy(&header, bytes.data(), sizeof header);
    if (bytes.size() < sizeof header || header.magic != kMagic)
        throw Error(ErrorCode::WrongFormat, name + " is not a saved state of a simulation");
    if (header.version != kVersion)
        throw Error(ErrorCode::UnsupportedVersion, name + " has version " + std::to_string(header.version) +
                                                       " of saved states, but this library reads version " +
                                                       std::to_string(kVersion) +
                                                       "; save the simulation again");
    const std::span<const std::byte> body = bytes.subspan(sizeof header);
    if (body.size() != header.byte_count)
        throw Error(ErrorCode::Damaged, name + " should have " + std::to_string(header.byte_count) +
                                            " bytes after its header and has " + std::to_string(body.size()));
    if (XXH64(body.data(), body.size(), 0) != header.checksum)
        throw Error(ErrorCode::Damaged,
                    name + " was changed since it was saved: its checksum does not match");
    return body;
}

void require_same(const StateFingerprint& saved, const StateFingerprint& here, const std::string& name) {
    const auto refuse = [&](const std::string& what) {
        throw Error(ErrorCode::InvalidOptions, name + " belongs to a simulation with " + what +
                                                   "; restore it in a simulation that was made of the same");
    };
    if (saved.deformable != here.deformable)
        refuse("another deformable, other filters or other initial positions");
    if (saved.colliders.size() != here.colliders.size())
        refuse(std::to_string(saved.colliders.size()) + " colliders, not " +
               std::to_string(here.colliders.size()));
    for (std::size_t c = 0; c < saved.colliders.size(); ++c)
        if (saved.colliders[c] != here.colliders[c])
            refuse("another map, scale or initial pose of collider " + std::to_string(c));
    if (saved.options != here.options) refuse("other options");
}

} // namespace

std::vector<std::byte> Simulation::save_state() const {
    StateArchive state;
    StateFingerprint fingerprint = solver_->fingerprint();
    archive(state, fingerprint);
    solver_->archive(state);
    const std::vector<std::byte>& body = state.written();
    const Header header{.byte_count = body.size(), .checksum = XXH64(body.data(), body.size(), 0)};
    std::vector<std::byte> bytes(sizeof header + body.size());
    std::memcpy(bytes.data(), &header, sizeof header);
    std::memcpy(bytes.data() + sizeof header, body.data(), body.size());
    return bytes;
}

void Simulation::restore_state(std::span<const std::byte> bytes, const std::string& name) {
    StateArchive state(checked(bytes, name), name);
    StateFingerprint saved;
    archive(state, saved);
    require_same(saved, solver_->fingerprint(), name);
    // Reads into a copy, so that nothing has changed if it throws.
    auto restored = solver_->copy();
    restored->archive(state);
    state.finish();
    solver_ = std::move(restored);
}

void Simulation::save_state(const std::filesystem::path& path) const {
    const std::vector<std::byte> bytes = save_state();
    AtomicFile file(path);
    file.write(bytes.data(), bytes.size());
    file.commit();
}

void Simulation::restore_state(const std::filesystem::path& path) {
    restore_state(read_file(path), path.string());
}

} // namespace echinus
