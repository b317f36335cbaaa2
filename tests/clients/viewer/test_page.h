// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <map>

#include "read_bytes.h"
#include "ws_client.h"

namespace palpate::testing {

/// A page without a screen: keeps what comes, acknowledges frames, drags. Threads: one.
class TestPage {
 public:
  struct Tool {
    std::uint32_t id, state, flags, mine;
    std::array<float, 3> tip, proxy, force;
    float penetration;
  };
  struct Answer {
    std::uint32_t tool, flags;
    double t_us;
    float force;
  };

  explicit TestPage(const WsRequest& request) : client(request) {}

  /// Takes messages for this time, or until `enough` holds. @return whether it held
  bool listen(std::chrono::milliseconds time, const std::function<bool()>& enough = {});

  [[nodiscard]] bool has(const std::string& type) const { return texts.contains(type); }
  [[nodiscard]] bool serving() const { return has("state") && texts.at("state")["server"] == "serving"; }

  /// Waits for surface and a frame with a field. @return whether they came within 20 s
  [[nodiscard]] bool connect();

  /// Holds the tip `depth` below the highest accessible node for this time, or until `enough` holds.
  bool press(double depth, std::chrono::milliseconds time, const std::function<bool()>& enough = {});

  WsClient client;
  bool acknowledges{true};
  std::map<std::string, nlohmann::json> texts;  ///< the newest of each type
  std::vector<std::uint8_t> mesh;
  std::array<float, 3> top{};  ///< rest position of that node
  std::vector<Answer> answers;
  std::vector<Tool> tools;                ///< of the newest frame
  std::vector<std::uint32_t> frame_seqs;  ///< of all
  std::size_t frame_size{0};
  double largest_displacement{0.0};  ///< of the newest field, m
  std::uint32_t frame_revision{0};
  std::uint64_t surface_seq{0};  ///< of the newest field
  double sent_us{0.0};           ///< of the newest frame
  std::uint16_t close_code{0};
  bool closed{false};

 private:
  void take(const WsMessage& message);
  void takeMesh(const std::vector<std::uint8_t>& bytes);
  void takeFrame(const std::vector<std::uint8_t>& bytes);
};

}  // namespace palpate::testing
