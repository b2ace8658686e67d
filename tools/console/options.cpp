#include "console/options.hpp"

#include "files/text.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <sstream>
#include <string_view>

namespace {

/// CLI11 leaves options of this group out of the help.
constexpr const char* kHidden = "";

/// A number of bytes written with its unit, as "300KB" or "0.3MB"; nothing for any other text.
std::optional<std::size_t> parse_byte_count(std::string_view text) {
    constexpr std::pair<std::string_view, double> kUnits[] = {{"B", 1},
                                                              {"KB", 1e3},
                                                              {"MB", 1e6},
                                                              {"GB", 1e9},
                                                              {"KiB", 1024},
                                                              {"MiB", 1024 * 1024},
                                                              {"GiB", 1024 * 1024 * 1024}};
    constexpr double kMost = 1e15; // still fits into a number of bytes
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{}) return {};
    const std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
    for (const auto& [name, size] : kUnits)
        if (unit == name && number * size >= 1 && number * size <= kMost)
            return static_cast<std::size_t>(number * size);
    return {};
}

CLI::Option* add_option(CLI::App& app, const std::string& name, const ArgumentTarget& target,
                        const std::string& description) {
    if (const auto* parse = std::get_if<std::function<bool(const std::string&)>>(&target)) {
        const auto parse_first = [parse = *parse](const CLI::results_t& texts) {
            return parse(texts.front());
        };
        return app.add_option(name, parse_first, description);
    }
    return std::visit(
        [&](auto variable) -> CLI::Option* {
            using Variable = decltype(variable);
            if constexpr (std::is_same_v<Variable, std::filesystem::path*>) {
                return app.add_option_function<std::string>(
                    name, [variable](const std::string& text) { *variable = echinus::utf8_path(text); },
                    description);
            } else if constexpr (std::is_same_v<Variable, std::vector<std::filesystem::path>*>) {
                const auto store = [variable](const std::vector<std::string>& texts) {
                    variable->clear();
                    for (const std::string& text : texts) variable->push_back(echinus::utf8_path(text));
                };
                return app.add_option_function<std::vector<std::string>>(name, store, description);
            } else if constexpr (std::is_pointer_v<Variable>) {
                return app.add_option(name, *variable, description);
            }
            return nullptr; // the function, which was handled above
        },
        target);
}

template <typename T>
bool parse_numbers(std::string_view text, char separator, const std::vector<T*>& numbers) {
    for (T* const number : numbers) {
        const bool last = number == numbers.back();
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), *number);
        text.remove_prefix(static_cast<std::size_t>(end - text.data()));
        if (error != std::errc{} || (last ? !text.empty() : !text.starts_with(separator))) return false;
        if (!last) text.remove_prefix(1);
    }
    return true;
}

template <typename T>
ArgumentTarget parser_of(char separator, std::initializer_list<T*> numbers) {
    return [separator, numbers = std::vector<T*>(numbers)](const std::string& text) {
        return parse_numbers(text, separator, numbers);
    };
}

/// The word for which a mistyped word may stand; nothing if none is similar.
std::optional<std::string> nearest_of(const std::vector<std::string>& words, const std::string& mistyped) {
    const auto distance = [&](const std::string& word) { return echinus::edit_distance(mistyped, word); };
    const auto nearest = std::min_element(
        words.begin(), words.end(), [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
    if (nearest == words.end() || distance(*nearest) > mistyped.size() / 3 + 1) return {};
    return *nearest;
}

std::vector<std::string> command_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
        if (!command->get_name().empty()) names.push_back(command->get_name()); // not a group of options
    return names;
}

/// The names of a command's options, including those of its groups.
std::vector<std::string> option_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option :
         app.get_options([](const CLI::Option* o) { return o->get_group() != kHidden; }))
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const CLI::App* group : app.get_subcommands([](const CLI::App*) { return true; }))
        if (group->get_name().empty())
            for (std::string& name : option_names(*group)) names.push_back(std::move(name));
    return names;
}

/// The command that was given last.
const CLI::App& innermost(const CLI::App& app) {
    for (const CLI::App* given : app.get_subcommands())
        if (!given->get_name().empty()) return innermost(*given);
    return app;
}

/// The form of an option's value, such as COUNTxCOUNT; empty for a name that the command does not have.
std::string type_of_option(const CLI::App& command, const std::string& name) {
    if (const CLI::Option* option = command.get_option_no_throw(name)) return option->get_type_name();
    for (const CLI::App* group : command.get_subcommands([](const CLI::App*) { return true; }))
        if (group->get_name().empty())
            if (std::string type = type_of_option(*group, name); !type.empty()) return type;
    return {};
}

/// For a command or an option that does not exist, names a similar one and the existing commands; nothing if
/// all given ones exist. CLI11 only reports that words were left over.
std::optional<std::string> sentence_about_unknown(const CLI::App& app) {
    const CLI::App& command = innermost(app);
    for (const std::string& word : app.remaining(true)) {
        const bool is_option = word.size() > 1 && word.starts_with('-');
        const std::vector<std::string> commands = command_names(command);
        if (!is_option && commands.empty()) continue;
        const std::string name = word.substr(0, word.find('='));
        const auto nearest = nearest_of(is_option ? option_names(command) : commands, name);
        std::string sentence =
            is_option ? "there is no option " + name : "there is no command '" + word + "'";
        if (nearest) sentence += "; the nearest is " + *nearest;
        if (is_option) return sentence;
        for (const std::string& known : commands)
            sentence += (&known == &commands.front() ? "; the commands are " : ", ") + known;
        return sentence;
    }
    return {};
}

/// @param found  CLI11's "Could not convert: OPTION = VALUE"
std::string sentence_about_value(const CLI::App& app, const std::string& found) {
    const std::size_t colon = found.find(": "), equals = found.find(" = ");
    if (colon == std::string::npos || equals == std::string::npos) return found;
    const std::string option = found.substr(colon + 2, equals - colon - 2), value = found.substr(equals + 3);
    if (value == "=")
        return option + ": '=' is not a valid value; write it as " + option + " VALUE or " + option +
               "=VALUE";
    const std::string form = type_of_option(innermost(app), option);
    return option + ": '" + value + "' is not a valid value" + (form.empty() ? "" : "; expected " + form);
}

} // namespace

Option Option::required() const {
    option_->required();
    return *this;
}

Option Option::range(std::uint64_t least, std::uint64_t most) const {
    option_->check(CLI::Range(least, most));
    return *this;
}

Option Option::not_empty() const {
    option_->check([](const std::string& text) { return text.empty() ? "must name a file" : ""; });
    return *this;
}

Option Option::ends_in(const std::string& ending) const {
    option_->check([ending](const std::string& text) {
        const std::filesystem::path file = echinus::utf8_path(text);
        std::string own = file.extension().string();
        std::transform(own.begin(), own.end(), own.begin(),
                       [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
        if (own.empty() || own == ending) return std::string();
        return "ends in " + file.extension().string() + ", but the output is " + ending.substr(1) +
               "; name it " + std::filesystem::path(file).replace_extension(ending).string();
    });
    return *this;
}

Option Option::excludes(const std::string& other_option) const {
    option_->excludes(other_option);
    return *this;
}

Option Option::type_name(const std::string& name) const {
    option_->type_name(name);
    return *this;
}

Option Option::show_default() const {
    option_->capture_default_str();
    return *this;
}

Option Option::default_text(const std::string& text) const {
    option_->default_str(text);
    return *this;
}

bool Option::given() const {
    return option_->count() > 0;
}

std::string Option::name() const {
    return option_->get_name();
}

Command Command::add_command(const std::string& name, const std::string& description) const {
    return Command(app_->add_subcommand(name, description));
}

void Command::require_command(const std::string& noun) const {
    // A missing command is refused here, because CLI11 would not report a misspelt one.
    app_->require_subcommand(0, 1);
    app_->callback([app = app_, noun] {
        if (app->get_subcommands().empty()) throw WrongUse(noun + " is required");
    });
}

Command Command::add_group(const std::string& title) const {
    return Command(app_->add_option_group(title));
}

Option Command::add(const std::string& name, ArgumentTarget target, const std::string& description) const {
    return Option(add_option(*app_, name, target, description));
}

Option Command::add_flag(const std::string& name, bool& variable, const std::string& description) const {
    return Option(app_->add_flag(name, variable, description));
}

void Command::add_former(const std::string& name, const std::string& successor) const {
    const std::function<void(std::int64_t)> refuse = [name, successor](std::int64_t) {
        throw WrongUse(name + " is now " + successor);
    };
    app_->add_flag(name, refuse)->group(kHidden);
}

Option Command::add_byte_count(const std::string& name, std::size_t& variable,
                               const std::string& description) const {
    const auto store = [name, &variable](const std::string& text) {
        const std::optional<std::size_t> bytes = parse_byte_count(text);
        if (!bytes)
            throw WrongUse(name, "must be a number of bytes, at least one and at most 1000000GB, with one of "
                                 "the units B, KB, MB, GB, KiB, MiB and GiB, such as 300KB, not " +
                                     text);
        variable = *bytes;
        return true;
    };
    return add(name, store, description).type_name("SIZE");
}

Option Command::add_numbers(const std::string& name, char separator,
                            std::initializer_list<std::uint32_t*> variables,
                            const std::string& description) const {
    return add(name, parser_of(separator, variables), description);
}

Option Command::add_numbers(const std::string& name, char separator, std::initializer_list<double*> variables,
                            const std::string& description) const {
    return add(name, parser_of(separator, variables), description);
}

void Command::footer(const std::string& text) const {
    app_->footer(text);
}

void Command::action(std::function<void()> act) const {
    app_->callback(std::move(act));
}

Program::Program(const std::string& name, const std::string& description)
    : app_(std::make_unique<CLI::App>(description, name)) {}

Program::~Program() = default;

void Program::add_version(const std::string& text) {
    app_->set_version_flag("--version", text);
}

std::string Program::given_command() const {
    std::string path = app_->get_name();
    for (const CLI::App* app = app_.get(); app != nullptr;) {
        const CLI::App* inner = nullptr;
        for (const CLI::App* given : app->get_subcommands())
            if (!given->get_name().empty()) inner = given;
        if (inner != nullptr) path += " " + inner->get_name();
        app = inner;
    }
    return path;
}

std::optional<std::string> Program::run(const std::vector<std::string>& arguments) {
    try {
        // CLI11 expects the arguments in reverse order.
        app_->parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
        return std::nullopt;
    } catch (const CLI::Success& help_or_version) {
        std::ostringstream text;
        app_->exit(help_or_version, text, text);
        return text.str().ends_with('\n') ? text.str() : text.str() + "\n"; // missing in nested commands
    } catch (const CLI::ConversionError& error) {
        throw WrongUse(sentence_about_value(*app_, error.what()));
    } catch (const CLI::ParseError& error) {
        // The option that is reported missing may be a mistyped one.
        throw WrongUse(sentence_about_unknown(*app_).value_or(error.what()));
    }
}
