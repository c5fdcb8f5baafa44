// flinch graph: the diagram of a scenario as a page, a picture or text.
#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "apps/flinch/command_line.h"
#include "apps/flinch/output_place.h"
#include "apps/flinch/printing.h"
#include "apps/flinch/shell_word.h"
#include "apps/flinch/simulated/simulated_parts.h"
#include "experiments/graph/graph_page.h"
#include "systems/foundation/bytes_of_file.h"
#include "systems/foundation/json_text.h"
#include "systems/foundation/result_file.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/diagram.h"

namespace flinch {
namespace {

using Json = nlohmann::ordered_json;

OutputKind form_of_graph(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  if (file.empty() || extension == ".dot") return OutputKind::graph;
  if (extension == ".svg") return OutputKind::picture;
  if (extension == ".html" || extension == ".htm") return OutputKind::page;
  throw SetupError(file.string() + ": a graph is written as .html, .svg or .dot, not as '" + extension + "'");
}

/// Lets Graphviz draw `dot` into `picture`, which is to be `file`.
void draw(const std::string& dot, const std::filesystem::path& file, const ResultFile& picture) {
  const ResultFile source(file.string() + ".dot");  // never finished
  source.write(dot);
  const std::string command =
      "dot -Tsvg -o " + shell_word(picture.unfinished_name()) + " " + shell_word(source.unfinished_name());
  if (std::system(command.c_str()) == 0) return;
  throw SetupError(file.string() +
                   ": Graphviz could not draw it; is the program 'dot' installed (package graphviz)?");
}

void draw_svg(const std::string& dot, const std::filesystem::path& file) {
  ResultFile picture(file);
  draw(dot, file, picture);
  picture.finish();
}

/// The picture of `dot`, for a page at `file`.
std::string picture_of(const std::string& dot, const std::filesystem::path& file) {
  const ResultFile picture(file.string() + ".svg");  // never finished
  draw(dot, file, picture);
  const std::string text = bytes_of_file(picture.unfinished_name());
  return text.substr(std::min(text.find("<svg"), text.size()));
}

void write_page(const Diagram& diagram, const GraphOptions& options) {
  const GraphFacts facts{.name = options.scenario.stem().string(), .call = options.common.command_line};
  const auto draw_level = [&](const std::string& dot) { return picture_of(dot, options.out); };
  write_result(options.out, graph_page(diagram, facts, draw_level));
}

}  // namespace

ExitStatus graph(const GraphOptions& options) {
  const OutputKind kind = form_of_graph(options.out);
  require_output(options.out, {options.scenario}, kind);
  const std::unique_ptr<const Diagram> diagram = closed_loop(options.scenario);
  if (options.out.empty()) {
    const std::string dot = diagram->graphviz();
    print_result("{}", options.common.json ? json_text(Json{{"dot", dot}}) + "\n" : dot);
    return ExitStatus::done;
  }
  switch (kind) {
    case OutputKind::page:
      write_page(*diagram, options);
      break;
    case OutputKind::picture:
      draw_svg(diagram->graphviz(), options.out);
      break;
    default:
      write_result(options.out, diagram->graphviz());
  }
  if (options.common.json) {
    print_result("{}\n", json_text(Json{{"graph", options.out.string()}}));
  } else if (!options.common.quiet) {
    print_result("graph: {}\n", options.out.string());
  }
  return ExitStatus::done;
}

}  // namespace flinch
