#include "console/options.hpp"

#include <CLI/CLI.hpp>

#include <charconv>
#include <sstream>
#include <string_view>

namespace {

/// A number of bytes written with its unit, as "300KB" or "0.3MB"; nothing for any other text.
std::optional<std::size_t> parse_byte_count(std::string_view text) {
    constexpr std::pair<std::string_view, double> kUnits[] = {{"B", 1},
                                                              {"KB", 1e3},
                                                              {"MB", 1e6},
                                                              {"GB", 1e9},
                                                              {"KiB", 1024},
                                                              {"MiB", 1024 * 1024},
                                                              {"GiB", 1024 * 1024 * 1024}};
    constexpr double kMost = 1e15; // still fits a number of bytes
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
            if constexpr (std::is_pointer_v<decltype(variable)>)
                return app.add_option(name, *variable, description);
            return nullptr; // the function, dealt with above
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

/// Of a command that does not exist, says which do; nothing when all commands that were given exist. CLI11
/// only says that words were left over.
std::optional<std::string> sentence_about_command(const CLI::App& app) {
    const std::vector<CLI::App*> given = app.get_subcommands();
    if (!given.empty()) return sentence_about_command(*given.front());
    const std::vector<std::string> words = app.remaining();
    const auto is_command = [](const CLI::App* sub) {
        return !sub->get_name().empty();
    }; // not a group of options
    const std::vector<const CLI::App*> commands = app.get_subcommands(is_command);
    const bool has_name = !words.empty() && !words.front().starts_with('-');
    if (commands.empty() || !has_name) return {};
    std::string names;
    for (const CLI::App* command : commands) names += (names.empty() ? "" : ", ") + command->get_name();
    return "'" + words.front() + "' is no command; there are " + names;
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
    app_->require_subcommand(0, 1); // a missing one is refused here: CLI11 would not report a misspelt one
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

std::optional<std::string> Program::run(int argument_count, const char* const* arguments) {
    try {
        app_->parse(argument_count, arguments);
        return std::nullopt;
    } catch (const CLI::Success& help_or_version) {
        std::ostringstream text;
        app_->exit(help_or_version, text, text);
        return text.str().ends_with('\n') ? text.str() : text.str() + "\n"; // forgotten in nested commands
    } catch (const CLI::ExtrasError& error) {
        throw WrongUse(sentence_about_command(*app_).value_or(error.what()));
    } catch (const CLI::ParseError& error) {
        throw WrongUse(error.what());
    }
}
