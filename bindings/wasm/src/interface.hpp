#pragma once

#include "handles.hpp"

#include <initializer_list>
#include <iterator>
#include <memory>
#include <vector>

/// The module exports the functions of echinus.h that js/ calls, and those in this folder for what the C
/// interface lacks: files in memory, scenes in parts, and the insides of maps. They follow the rules of
/// echinus.h, but texts and JSON are arrays of bytes.
#define ECHINUS_EXPORT(NAME) extern "C" __attribute__((export_name(#NAME)))

namespace echinus::wasm {

using namespace echinus::c;

/// Lists of numbers, each preceded by its length, in the order in which js/ takes them; texts are lists of
/// bytes.
class Lists {
  public:
    void add(const auto& list) {
        numbers_.push_back(static_cast<double>(std::size(list)));
        for (const auto& number : list) numbers_.push_back(static_cast<double>(number));
    }
    echinus_array array() const { return array_of(numbers_); }

  private:
    std::vector<double> numbers_;
};

/// Stores all of these arrays, or none.
inline void put_arrays(std::initializer_list<echinus_array**> places,
                       std::initializer_list<echinus_array> arrays) {
    std::vector<std::unique_ptr<echinus_array>> made;
    for (const echinus_array& array : arrays) made.push_back(std::make_unique<echinus_array>(array));
    auto next = made.begin();
    for (echinus_array** place : places) *place = (next++)->release();
}

} // namespace echinus::wasm
