#pragma once

#include <echinus/echinus.h>
#include <echinus/scene.hpp>

#include <filesystem>

struct echinus_scene {
    echinus::Scene value;
    std::filesystem::path folder; ///< files of the scene may lie in it
};
