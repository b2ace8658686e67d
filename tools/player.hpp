#pragma once

#include <filesystem>
#include <string>
#include <string_view>

/// The page that plays recordings, as `scripts/web` builds it, cut in two where a recording goes.
class Player {
  public:
    /// @param path  empty: the one that is installed with this program
    /// @throws echinus::Error Unreadable or WrongFormat; the sentence says how to get a player
    explicit Player(std::filesystem::path path);

    std::string_view head() const { return std::string_view(page_).substr(0, place_); }
    std::string_view tail() const;

  private:
    std::string page_;
    std::size_t place_;
};
