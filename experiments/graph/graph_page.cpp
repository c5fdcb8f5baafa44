#include "experiments/graph/graph_page.h"

#include <cxxabi.h>

#include <cstdlib>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <vector>

#include "experiments/graph/page/graph_page_template.h"
#include "experiments/report/script_data.h"
#include "systems/foundation/json_text.h"
#include "systems/framework/diagram_levels.h"
#include "systems/framework/dot_text.h"

namespace flinch {
namespace {

using GraphJson = nlohmann::ordered_json;

/// The name of a type in C++, without namespaces of its own.
std::string name_of(const std::type_info& type) {
  int status = 0;
  const std::unique_ptr<char, void (*)(void*)> plain(
      abi::__cxa_demangle(type.name(), nullptr, nullptr, &status), std::free);
  std::string name = status == 0 ? plain.get() : type.name();
  for (const std::string_view space : {"flinch::", "(anonymous namespace)::", "internal::"}) {
    for (std::size_t at = name.find(space); at != std::string::npos; at = name.find(space))
      name.erase(at, space.size());
  }
  return name;
}

/// Describes a diagram for the script of the page.
class GraphDescription {
 public:
  explicit GraphDescription(const Diagram& root) : paths_(root) { follow_wires(root); }

  GraphJson of(const System& block) {
    GraphJson description = {
        {"name", block.name()}, {"path", paths_.of(block)}, {"type", name_of(typeid(block))}};
    description["inputs"] = ports(block, PortId::Kind::input, block.inputs());
    description["outputs"] = ports(block, PortId::Kind::output, block.outputs());
    if (const auto* diagram = dynamic_cast<const Diagram*>(&block)) {
      description["type"] = "diagram";
      description["children"] = GraphJson::array();
      for (const auto& child : diagram->children()) description["children"].push_back(of(*child));
    }
    return description;
  }

  /// The fields of each kind of signal that was described.
  GraphJson fields() const {
    GraphJson all = GraphJson::object();
    for (const ValueType* const type : types_) {
      GraphJson fields = GraphJson::array();
      const RowLayout layout = type->layout == nullptr ? RowLayout{} : type->layout();
      for (const Field& field : layout.fields)
        fields.push_back({{"name", field.name}, {"unit", field.unit}, {"frame", field.frame}});
      all[name_of(*type->id)] = std::move(fields);
    }
    return all;
  }

 private:
  void follow_wires(const Diagram& diagram) {
    for (const Diagram::Wire& wire : wires_to_outputs(diagram)) connect(wire.from, wire.to);
    for (const auto& child : diagram.children()) {
      if (const auto* nested = dynamic_cast<const Diagram*>(child.get())) follow_wires(*nested);
    }
  }

  void connect(PortId from, PortId to) {
    fed_by_[paths_.of(to)] = paths_.of(from);
    feeds_[paths_.of(from)].push_back(paths_.of(to));
  }

  template <class Ports>
  GraphJson ports(const System& block, PortId::Kind kind, const Ports& declared) {
    GraphJson all = GraphJson::array();
    for (std::size_t i = 0; i < declared.size(); ++i) {
      if constexpr (requires { declared[i].intermediate; }) {
        if (declared[i].intermediate) continue;
      }
      const std::string path = paths_.of({&block, kind, static_cast<int>(i)});
      types_.insert(declared[i].type);
      all.push_back({{"name", declared[i].name}, {"path", path}, {"type", name_of(*declared[i].type->id)}});
      if (const auto from = fed_by_.find(path); from != fed_by_.end()) all.back()["from"] = from->second;
      if (const auto to = feeds_.find(path); to != feeds_.end()) all.back()["to"] = to->second;
    }
    return all;
  }

  PortPaths paths_;
  std::map<std::string, std::string> fed_by_;              ///< by the port that is fed
  std::map<std::string, std::vector<std::string>> feeds_;  ///< by the port that feeds
  std::set<const ValueType*> types_;
};

GraphJson pictures_of(const Diagram& diagram, const DrawGraph& draw) {
  GraphJson pictures = GraphJson::object();
  for (const DiagramLevel& level : levels_of(diagram)) pictures[level.path] = draw(level.dot);
  return pictures;
}

}  // namespace

std::string graph_page(const Diagram& diagram, const GraphFacts& facts, const DrawGraph& draw) {
  GraphDescription description(diagram);
  GraphJson data = {{"name", facts.name}, {"root", description.of(diagram)}};
  data["fields"] = description.fields();
  data["pictures"] = pictures_of(diagram, draw);
  data["tick_us"] = std::chrono::duration<double, std::micro>(diagram.tick()).count();
  data["call"] = facts.call;
  data["version"] = "flinch " FLINCH_VERSION;
  return std::string(graph_page_template_before_data) + inside_script(json_text(data)) +
         std::string(graph_page_template_after_data);
}

}  // namespace flinch
