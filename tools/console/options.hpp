#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

// The command line, parsed by CLI11, which only options.cpp includes: it takes seconds to compile.

namespace CLI {
class App;
class Option;
} // namespace CLI

/// The arguments make no sense: exit status 2.
class WrongUse : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
    /// "OPTION: FINDING"
    WrongUse(const std::string& option, const std::string& finding)
        : std::runtime_error(option + ": " + finding) {}
};

/// The target of an option's argument: a variable, which must outlive the parsing, or a function that
/// receives the text and, if it cannot use it, returns false or throws WrongUse with a better sentence. A
/// list accepts one or more arguments.
using ArgumentTarget =
    std::variant<std::string*, std::filesystem::path*, std::vector<std::filesystem::path>*, double*, float*,
                 std::uint32_t*, std::uint64_t*, std::optional<double>*, std::optional<std::uint32_t>*,
                 std::optional<std::int64_t>*, std::function<bool(const std::string&)>>;

/// An option or positional argument of a command, which it refers to.
class Option {
  public:
    explicit Option(CLI::Option* option) : option_(option) {}

    Option required() const;
    /// Whole numbers from `least` to `most` only.
    Option range(std::uint64_t least, std::uint64_t most) const;
    Option not_empty() const;
    /// Accepts only file names with this extension, in upper or lower case, names without an extension, and
    /// "-". @param ending  for instance ".png"
    Option ends_in(const std::string& ending) const;
    Option excludes(const std::string& other_option) const;
    /// The argument's name in the help.
    Option type_name(const std::string& name) const;
    /// The help shows the variable's value as the default.
    Option show_default() const;
    Option default_text(const std::string& text) const;

    bool given() const;
    /// The option's name in sentences: "--json".
    std::string name() const;

  private:
    CLI::Option* option_;
};

/// A command, or a group of its options in the help. Refers to members of the Program.
class Command {
  public:
    explicit Command(CLI::App* app) : app_(app) {}

    Command add_command(const std::string& name, const std::string& description) const;
    /// Makes it wrong use to give no subcommand; the sentence is "NOUN is required".
    void require_command(const std::string& noun) const;
    Command add_group(const std::string& title) const;
    /// A name without dashes adds a positional argument.
    Option add(const std::string& name, ArgumentTarget target, const std::string& description = "") const;
    Option add_flag(const std::string& name, bool& variable, const std::string& description) const;
    /// Adds an option of earlier versions, whose use is refused: "NAME is now SUCCESSOR". The help omits it.
    void add_former(const std::string& name, const std::string& successor) const;
    /// A number of bytes with its unit, such as 300KB.
    Option add_byte_count(const std::string& name, std::size_t& variable,
                          const std::string& description) const;
    /// Numbers with a character between them, such as 60x24.
    Option add_numbers(const std::string& name, char separator,
                       std::initializer_list<std::uint32_t*> variables, const std::string& description) const;
    Option add_numbers(const std::string& name, char separator, std::initializer_list<double*> variables,
                       const std::string& description) const;
    void footer(const std::string& text) const;
    /// The action to run when the command is given.
    void action(std::function<void()> act) const;

  private:
    CLI::App* app_;
};

/// The whole command line.
class Program {
  public:
    Program(const std::string& name, const std::string& description);
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;
    ~Program();

    Command command() { return Command(app_.get()); }
    /// Adds --version.
    void add_version(const std::string& text);
    /// The program and the commands that were given, such as "echinus mesh torus".
    std::string given_command() const;
    /// Parses the arguments after the program's name and runs the actions of the commands that they name.
    /// @returns the help or version to print, if it was requested
    /// @throws WrongUse, and the errors of the actions
    std::optional<std::string> run(const std::vector<std::string>& arguments);

  private:
    std::unique_ptr<CLI::App> app_;
};

/// An option that takes one of a few words, each of which stands for a value of T; the variable keeps its
/// value as the default.
template <typename T>
Option add_choice(Command command, const std::string& name, T& variable,
                  const std::vector<std::pair<std::string, T>>& choices, const std::string& description) {
    std::string words;
    std::string default_word;
    for (const auto& [word, value] : choices) {
        words += (words.empty() ? "" : "|") + word;
        if (value == variable) default_word = word;
    }
    const auto choose = [name, &variable, choices, words](const std::string& text) {
        for (const auto& [word, value] : choices) {
            if (word == text) {
                variable = value;
                return true;
            }
        }
        throw WrongUse(name, "'" + text + "' is not one of " + words);
    };
    return command.add(name, choose, description).type_name(words).default_text(default_word);
}
