#pragma once

#include "rivals/vdb.hpp"

#include <openvdb/openvdb.h>

/// Shared by the two files of vdb.hpp.
struct OpenVdbRival::Impl {
    openvdb::FloatGrid::Ptr grid;

    explicit Impl(const echinus::TriangleMesh& mesh);
};
