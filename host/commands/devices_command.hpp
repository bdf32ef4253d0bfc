// `diptych devices`: what there is to render on.
#pragma once

namespace CLI {
class App;
}

namespace diptych {

CLI::App* add_devices_command(CLI::App& app);

// Always 0: that nothing is installed is an answer.
int run_devices_command();

}  // namespace diptych
