#include "app/command/mistyped.hpp"

#include "osculate/scene/nearest.hpp"

#include <fmt/format.h>
#include <vector>

namespace osculate::app {

std::string mistyped(const CLI::App& program) {
    const std::vector<CLI::App*> chosen = program.get_subcommands();
    const CLI::App& app = chosen.empty() ? program : *chosen.front();
    std::vector<std::string> names;
    if (chosen.empty())
        for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; }))
            names.push_back(command->get_name());
    for (const CLI::Option* option : app.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);

    std::string text;
    for (const std::string& word : program.remaining(true)) {
        const bool option = word.starts_with('-');
        if (chosen.empty() && !option && !text.empty()) break; // what follows belongs to the command
        const std::string meant = scene::nearest(word.substr(0, word.find('=')), names);
        if (meant.empty() && !(chosen.empty() && !option)) continue;
        text += fmt::format("there is no {} '{}'", option ? "option" : "command", word);
        text += meant.empty() ? "; `osculate --help` lists them\n" : fmt::format("; did you mean '{}'?\n", meant);
    }
    return text;
}

} // namespace osculate::app
