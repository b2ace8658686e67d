#pragma once

#include "commands/simulation_result.hpp"
#include "output.hpp"
#include "recording/recording.hpp"

#include <echinus/mesh.hpp>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

/// The page that plays recordings, as built by `scripts/web`, cut in two at the place for a recording.
class Player {
  public:
    /// @param path  empty for the player installed with this program
    /// @throws echinus::Error Unreadable or WrongFormat; the sentence says how to get a player
    explicit Player(std::filesystem::path path);

    std::string_view head() const { return std::string_view(page_).substr(0, place_); }
    std::string_view tail() const;

  private:
    std::string page_;
    std::size_t place_;
};

/// The contents of a simulation's page.
struct PlayedSimulation {
    const SimulationResult& result;
    const Recording& recording;
    std::string scene_name; ///< without folders, since pages are shared
    std::string model_name;
    std::string notice;                               ///< of the model's source; may be empty
    std::span<const echinus::TriangleMesh> colliders; ///< scaled, but not moved
};

/// Writes one HTML document that plays the simulation and loads nothing from elsewhere: the player, and in it
/// a description as JSON and the shapes and positions, compressed (docs/command_line.md has the format).
/// @throws echinus::Error Unwritable
void write_player_page(Output& output, const Player& player, const PlayedSimulation& simulation);
