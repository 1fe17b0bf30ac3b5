// Tables of what is chosen by its name.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace donex::simulation {

/// Of all entries of a table, in its order; each has a `name`.
template <class Entry>
std::vector<std::string> namesOf(const std::vector<Entry>& table) {
  std::vector<std::string> names;
  for (const Entry& entry : table) names.emplace_back(entry.name);
  return names;
}

/// The entry of that name, or nullptr.
template <class Entry>
const Entry* findNamed(const std::vector<Entry>& table, const std::string& name) {
  const auto found = std::find_if(table.begin(), table.end(), [&](const Entry& entry) { return name == entry.name; });
  return found == table.end() ? nullptr : &*found;
}

}  // namespace donex::simulation
