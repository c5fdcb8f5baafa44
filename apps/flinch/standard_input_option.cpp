// '-' in the place of an input file.
#include "apps/flinch/verbs.h"
#include "systems/foundation/setup_error.h"
#include "systems/foundation/standard_input.h"

namespace flinch {

void take_standard_input(CLI::App& app) {
  for (CLI::Option* const option : app.get_options([](const CLI::Option* each) {
         return each->get_positional() && each->get_type_name() != "DIR";
       })) {
    option->transform(CLI::Validator(
        [](std::string& text) {
          try {
            if (text == standard_input_name) text = standard_input_file().string();
          } catch (const SetupError& error) {
            return std::string(error.what());
          }
          return std::string();
        },
        ""));
  }
  for (CLI::App* const verb : app.get_subcommands([](const CLI::App*) { return true; }))
    take_standard_input(*verb);
}

}  // namespace flinch
