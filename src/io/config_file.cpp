#include "io/config_file.h"

#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>

#include "io/settings.h"

namespace donex {
namespace {

std::string lineOf(const std::string& source, const YAML::Mark& mark) {
  return fmt::format("{}:{}", source, mark.line + 1);
}

/// All pairs of the map; a name given twice is a fault.
Settings readMap(const YAML::Node& map, const std::string& source, Faults& faults) {
  Settings settings;
  for (const auto& pair : map) {
    const std::string where = lineOf(source, pair.first.Mark());
    if (!pair.first.IsScalar()) {
      faults.add(where + ": the name of a parameter must be plain text");
      continue;
    }
    const std::string& name = pair.first.Scalar();
    const auto [other, is_new] = settings.insert({name, {pair.second, where, false}});
    if (!is_new) faults.add(fmt::format("{}: {} is set a second time, first at {}", where, name, other->second.where));
  }
  return settings;
}

/// Counts documents, without reading them.
class DocumentCounter : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark&) override { ++documents; }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}

  int documents = 0;
};

/// YAML::LoadAll never ends for some texts that are not YAML (as ",a"): it finds document after document in them.
bool holdsSeveralDocuments(const std::string& text) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  DocumentCounter counter;
  while (counter.documents < 2 && parser.HandleNextDocument(counter)) {
  }
  return counter.documents > 1;
}

/// Null where the text holds only comments.
YAML::Node parseFile(const std::string& text, const std::string& source) {
  try {
    if (holdsSeveralDocuments(text)) throw DataError(source + ": holds more than one YAML document");
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    const std::string where = error.mark.is_null() ? source : lineOf(source, error.mark);
    throw DataError(fmt::format("{}: is not YAML: {}", where, error.msg));
  }
}

/// Adds "name=value" to the settings, over an earlier one of that name.
void addSetting(const std::string& text, Settings& settings, Faults& faults) {
  const std::size_t equals = text.find('=');
  const bool has_name = equals != std::string::npos && equals != 0;
  if (!has_name) return faults.add(fmt::format("'{}': must be name=value", text));
  const std::string where = fmt::format("'{}'", text);
  try {
    const YAML::Node value = YAML::Load(text.substr(equals + 1));
    const std::string name = text.substr(0, equals);
    settings.erase(name);
    settings.insert({name, {value, where, false}});
  } catch (const YAML::Exception& error) {
    faults.add(fmt::format("{}: is not YAML: {}", where, error.msg));
  }
}

std::string readText(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream || std::filesystem::is_directory(file)) throw DataError(file.string() + ": cannot be read");
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

}  // namespace

Config readConfigFile(const std::filesystem::path& file, const Config& base) {
  const std::string source = file.string();
  const YAML::Node document = parseFile(readText(file), source);
  Config config = base;
  if (!document.IsDefined() || document.IsNull()) return config;
  if (!document.IsMap()) {
    throw DataError(lineOf(source, document.Mark()) + ": must be a map of parameter names to values");
  }
  Faults faults;
  Settings settings = readMap(document, source, faults);
  apply(settings, config, source, faults);
  faults.throwIfAny();
  return config;
}

void applySettings(Config& config, const std::vector<std::string>& texts) {
  Faults faults;
  Settings settings;
  for (const std::string& text : texts) addSetting(text, settings, faults);
  Config changed = config;
  apply(settings, changed, "the settings together", faults);
  if (!faults.empty()) throw SettingError(faults.text());
  config = changed;
}

}  // namespace donex
