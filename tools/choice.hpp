#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <utility>
#include <vector>

/// An option that takes one of a few words, each of which stands for a value of T; the variable keeps its
/// value as the default. Unlike CLI11's transformers it takes no numbers for the words.
template <typename T>
CLI::Option* add_choice(CLI::App& app, const std::string& option, T& variable,
                        const std::vector<std::pair<std::string, T>>& choices,
                        const std::string& description) {
    std::string words;
    std::string default_word;
    for (const auto& [word, value] : choices) {
        words += (words.empty() ? "" : "|") + word;
        if (value == variable) default_word = word;
    }
    const auto choose = [option, &variable, choices, words](const std::string& text) {
        for (const auto& [word, value] : choices) {
            if (word == text) {
                variable = value;
                return;
            }
        }
        throw CLI::ValidationError(option, "'" + text + "' is not one of " + words);
    };
    return app.add_option_function<std::string>(option, choose, description)
        ->type_name(words)
        ->default_str(default_word);
}
