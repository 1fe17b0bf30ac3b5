#include "bag/topics.h"

#include <algorithm>
#include <map>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "io/data_error.h"

namespace donex {
namespace {

using Topics = std::map<std::string, std::string>;  // topic -> type

/// A topic recorded from several publishers has several connections.
Topics topicsOf(rosbag::View& view) {
  Topics topics;
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    topics[connection->topic] = connection->datatype;
  }
  return topics;
}

std::string listed(const Topics& topics) {
  std::string text = topics.empty() ? "; it has no topics at all" : "; its topics are:";
  for (const auto& [topic, datatype] : topics) text += fmt::format("\n  {} ({})", topic, datatype);
  return text;
}

bool isOneOf(const Datatypes& datatypes, const std::string& type) {
  return std::find(datatypes.begin(), datatypes.end(), type) != datatypes.end();
}

std::string onlyTopic(const Topics& topics, const Datatypes& datatypes, const std::string& file,
                      const std::string& option) {
  std::vector<std::string> fitting;
  for (const auto& [topic, type] : topics) {
    if (isOneOf(datatypes, type)) fitting.push_back(topic);
  }
  if (fitting.size() == 1) return fitting.front();
  const std::string types = fmt::format("{}", fmt::join(datatypes, " or "));
  if (fitting.empty()) throw DataError(fmt::format("{}: has no topic of type {}{}", file, types, listed(topics)));
  throw DataError(fmt::format("{}: has {} topics of type {}, choose one with {}{}", file, fitting.size(), types, option,
                              listed(topics)));
}

std::string namedTopic(const Topics& topics, const std::string& wanted, const Datatypes& datatypes,
                       const std::string& file, const std::string& option) {
  for (const auto& [topic, type] : topics) {
    if (absoluteTopic(topic) != absoluteTopic(wanted)) continue;
    if (isOneOf(datatypes, type)) return topic;
    throw DataError(fmt::format("{}: topic {} is of type {}, must be {}{}", file, topic, type,
                                fmt::join(datatypes, " or "), listed(topics)));
  }
  throw DataError(fmt::format("{}: has no topic {} ({}){}", file, wanted, option, listed(topics)));
}

}  // namespace

std::string absoluteTopic(const std::string& topic) { return topic.rfind('/', 0) == 0 ? topic : "/" + topic; }

std::string chooseTopic(rosbag::View& view, const std::string& wanted, const Datatypes& datatypes,
                        const std::string& file, const std::string& option) {
  const Topics topics = topicsOf(view);
  return wanted.empty() ? onlyTopic(topics, datatypes, file, option)
                        : namedTopic(topics, wanted, datatypes, file, option);
}

bool hasTopicOf(rosbag::View& view, const std::string& datatype) {
  const Topics topics = topicsOf(view);
  return std::any_of(topics.begin(), topics.end(), [&](const auto& topic) { return topic.second == datatype; });
}

void requireNewTopic(rosbag::View& view, const std::string& topic, const std::string& file) {
  for (const auto& entry : topicsOf(view)) {
    if (absoluteTopic(entry.first) != absoluteTopic(topic)) continue;
    throw DataError(fmt::format("{}: has a topic {} already, choose another name with --labeled", file, topic));
  }
}

}  // namespace donex
