// launch/map.launch in a manager of its own: what the map is made of never leaves that process.
#include <string>
#include <vector>

#include <XmlRpcClient.h>
#include <gtest/gtest.h>
#include <ros/master.h>
#include <ros/network.h>

#include "ros/manager_rig.h"

namespace donex {
namespace {

using test::waitFor;
using XmlRpc::XmlRpcValue;

constexpr const char* kManager = "/donex_manager";

/// One end of a connection, as `rosnode info` shows it.
struct ConnectionEnd {
  std::string direction, transport, topic;  // "i" or "o"; "INTRAPROCESS", "TCPROS"; with its namespace
};

std::vector<ConnectionEnd> connectionsOf(const std::string& node) {
  XmlRpcValue request, response, uri;
  request[0] = ros::this_node::getName();
  request[1] = node;
  std::string host;
  std::uint32_t port = 0;
  const bool known = ros::master::execute("lookupNode", request, response, uri, false);
  if (!known || !ros::network::splitURI(std::string(uri), host, port)) return {};
  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port), "/");
  XmlRpcValue caller;
  caller[0] = ros::this_node::getName();
  if (!client.execute("getBusInfo", caller, response)) return {};
  std::vector<ConnectionEnd> ends;
  XmlRpcValue& infos = response[2];
  for (int i = 0; i < infos.size(); ++i) {
    ends.push_back({std::string(infos[i][2]), std::string(infos[i][3]), std::string(infos[i][4])});
  }
  return ends;
}

/// The transports of a topic's connections on the publishers' ("o") or the subscribers' ("i") side.
std::vector<std::string> transportsOf(const std::string& topic, const std::string& direction) {
  std::vector<std::string> transports;
  for (const ConnectionEnd& end : connectionsOf(kManager)) {
    if (end.topic == topic && end.direction == direction) transports.push_back(end.transport);
  }
  return transports;
}

TEST(Map, cloudsAreHandedOverWithinTheManager) {
  ros::NodeHandle nh;
  sensor_msgs::PointCloud2ConstPtr cells;
  const boost::function<void(const sensor_msgs::PointCloud2ConstPtr&)> take = [&](const auto& cloud) { cells = cloud; };
  const auto subscriber = nh.subscribe<sensor_msgs::PointCloud2>("/static_map/cells", 1, take);
  ASSERT_TRUE(waitFor([&] { return cells && cells->width > 100; }, 90.0)) << "there is no map";
  // LiDAR to classifier, classifier to filter, filter to octree.
  const std::vector<std::string> once{"INTRAPROCESS"};
  for (const std::string topic : {"/points", "/donex/static_points", "/thin_static_points/output"}) {
    EXPECT_EQ(transportsOf(topic, "o"), once) << topic;
    EXPECT_EQ(transportsOf(topic, "i"), once) << topic;
  }
  EXPECT_EQ(transportsOf("/static_map/cells", "o"), std::vector<std::string>{"TCPROS"}) << "this test is elsewhere";
}

}  // namespace
}  // namespace donex

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "map_test");
  ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
