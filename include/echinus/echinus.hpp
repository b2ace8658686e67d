#pragma once

/// Includes all of echinus::core. The mesh readers (mesh_io.hpp), scenes (echinus_scene/scene.hpp) and
/// rendering (echinus_render/render.hpp) are separate libraries with separate headers.

#include <echinus/any_map.hpp>
#include <echinus/collider.hpp>
#include <echinus/contact.hpp>
#include <echinus/custom_map.hpp>
#include <echinus/directions.hpp>
#include <echinus/distance_map.hpp>
#include <echinus/error.hpp>
#include <echinus/exact_map.hpp>
#include <echinus/exact_map_view.hpp>
#include <echinus/geometry.hpp>
#include <echinus/instruction_set.hpp>
#include <echinus/intersections.hpp>
#include <echinus/map_file.hpp>
#include <echinus/mesh.hpp>
#include <echinus/particle_collision.hpp>
#include <echinus/simulation.hpp>
#include <echinus/soft_body.hpp>
#include <echinus/surface_collision.hpp>
#include <echinus/surface_queries.hpp>
#include <echinus/tetrahedra.hpp>
#include <echinus/version.hpp>
