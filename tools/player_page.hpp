#pragma once

#include "output.hpp"
#include "player.hpp"
#include "recording.hpp"
#include "simulation_result.hpp"

#include <echinus/mesh.hpp>

#include <cstdint>
#include <string>

/// What a page tells and shows of a simulation.
struct PlayedSimulation {
    const SimulationResult& result;
    const Recording& recording;
    std::string scene_name; ///< without folders, since pages are handed on
    std::string model_name;
    std::string notice;                    ///< of the model's source; may be empty
    std::uint32_t cloth_columns;           ///< particles in each row of the sheet
    const echinus::TriangleMesh& collider; ///< scaled, not moved
};

/// Writes one HTML document that plays the simulation and loads nothing from elsewhere: the player, and in it
/// a description as JSON and the shapes and positions, compressed (docs/command_line.md has the format).
/// @throws echinus::Error Unwritable
void write_player_page(Output& output, const Player& player, const PlayedSimulation& simulation);
