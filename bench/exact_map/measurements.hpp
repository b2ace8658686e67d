#pragma once

#include "models.hpp"
#include "page.hpp"

// What is measured, one function a section of docs/exact_map_options.md. Each adds its tables to the values
// and writes its plots.

/// Bytes and times against the number of cells.
void measure_divisions(const Setting& setting, Values& values);

/// The bounding sphere's centre and the searched one.
void measure_centres(const Setting& setting, Values& values);

/// Bytes and build time against the number of faces.
void measure_face_counts(const Setting& setting, Values& values);

/// sweep().
void measure_chords(const Setting& setting, Values& values);

/// ExactMapBuilder::rebuild() beside ExactMap::build().
void measure_rebuilds(const Setting& setting, Values& values);

/// Meshes that are not closed.
void measure_open_surfaces(const Setting& setting, Values& values);
