#pragma once

#include "common/subjects.hpp"
#include "common/system.hpp"

/// Who takes part in a task on a mesh, ours and the rivals, in the order of the tables. The slow ones are
/// left out on large meshes.
std::vector<System> systems_for(Task task, const Subject& subject);

/// Those that come in sizes, from small to large.
std::vector<System> sizes_for(Task task, const echinus::TriangleMesh& mesh);

// ---- Parts of these lists

/// The rivals that this build has.
[[gnu::visibility("default")]] void list_rivals(Task task, const Subject& subject, std::vector<System>& list);
[[gnu::visibility("default")]] void list_sizes_of_rivals(Task task, const echinus::TriangleMesh& mesh,
                                                         std::vector<System>& list);
