#include "command.hpp"

#include <cstdio>
#include <exception>

namespace {

constexpr int kFailed = 1;
constexpr int kWrongUse = 2;

} // namespace

int main(int argc, char** argv) {
    CLI::App app{"Echinus: is a particle inside a rigid model, how deep, and which way out?"};
    app.name("echinus");
    app.set_version_flag("--version", "echinus " ECHINUS_VERSION);
    app.require_subcommand(1);

    try {
        app.parse(argc, argv);
        return 0;
    } catch (const CLI::CallForHelp& help) {
        return app.exit(help);
    } catch (const CLI::CallForVersion& version) {
        return app.exit(version);
    } catch (const CLI::ParseError& error) {
        std::fprintf(stderr, "echinus: %s; see echinus --help\n", error.what());
        return kWrongUse;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "echinus: %s\n", error.what());
        return kFailed;
    }
}
