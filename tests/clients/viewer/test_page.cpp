// SPDX-License-Identifier: Apache-2.0
#include "test_page.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace palpate::testing {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

std::array<float, 3> vectorAt(const std::vector<std::uint8_t>& bytes, std::size_t offset) {
  return {at<float>(bytes, offset), at<float>(bytes, offset + 4), at<float>(bytes, offset + 8)};
}

}  // namespace

bool TestPage::listen(milliseconds time, const std::function<bool()>& enough) {
  const auto end = Clock::now() + time;
  while (!closed && !(enough && enough())) {
    const auto left = std::chrono::duration_cast<milliseconds>(end - Clock::now());
    if (left.count() <= 0) return false;
    take(client.receive(left));
  }
  return !closed;
}

bool TestPage::connect() {
  return client.status() == 101 && listen(std::chrono::seconds(20), [this] {
           return serving() && !mesh.empty() && !frame_seqs.empty() && has("status") &&
                  texts["status"].contains("tools");
         });
}

bool TestPage::press(double depth, milliseconds time, const std::function<bool()>& enough) {
  const auto end = Clock::now() + time;
  const double radius = texts.at("mesh")["tip_radius"];
  while (Clock::now() < end && !(enough && enough())) {
    client.say(
        {{"type", "target"}, {"position", {top[0], top[1], static_cast<double>(top[2]) + radius - depth}}});
    listen(milliseconds(16));
  }
  return !enough || enough();
}

void TestPage::take(const WsMessage& message) {
  if (message.kind == WsMessage::Kind::kClosed) {
    closed = true;
    close_code = message.close_code;
  } else if (message.kind == WsMessage::Kind::kText) {
    const nlohmann::json text = message.json();
    texts[text["type"]] = text;
  } else if (message.kind == WsMessage::Kind::kBinary) {
    if (at<std::uint32_t>(message.bytes, 0) == 1) takeMesh(message.bytes);
    if (at<std::uint32_t>(message.bytes, 0) == 2) takeFrame(message.bytes);
  }
}

void TestPage::takeMesh(const std::vector<std::uint8_t>& bytes) {
  mesh = bytes;
  const std::size_t nodes = at<std::uint32_t>(bytes, 4);
  const std::size_t access = 20 + 12 * nodes + 12 * at<std::uint32_t>(bytes, 8);
  top = {0.0F, 0.0F, -1e9F};
  for (std::size_t i = 0; i < nodes; ++i) {
    const auto X = vectorAt(bytes, 20 + 12 * i);
    if (bytes.at(access + i) == 1 && X[2] > top[2]) top = X;
  }
}

void TestPage::takeFrame(const std::vector<std::uint8_t>& bytes) {
  frame_seqs.push_back(at<std::uint32_t>(bytes, 4));
  frame_revision = at<std::uint32_t>(bytes, 8);
  frame_size = bytes.size();
  const std::size_t nodes = at<std::uint32_t>(bytes, 12);
  int largest = 0;
  for (std::size_t i = 0; i < 3 * nodes; ++i)
    largest = std::max(largest, std::abs(static_cast<int>(at<std::int16_t>(bytes, 56 + 2 * i))));
  sent_us = at<double>(bytes, 24);
  if (nodes > 0) surface_seq = at<std::uint64_t>(bytes, 32);
  if (nodes > 0) largest_displacement = static_cast<double>(at<float>(bytes, 48)) * largest;
  std::size_t offset = toolsOffset(bytes);
  tools.clear();
  for (std::uint32_t i = 0; i < at<std::uint32_t>(bytes, 40); ++i, offset += 72)
    tools.push_back({at<std::uint32_t>(bytes, offset), at<std::uint32_t>(bytes, offset + 4),
                     at<std::uint32_t>(bytes, offset + 8), at<std::uint32_t>(bytes, offset + 12),
                     vectorAt(bytes, offset + 16), vectorAt(bytes, offset + 28), vectorAt(bytes, offset + 52),
                     at<float>(bytes, offset + 64)});
  for (std::uint32_t i = 0; i < at<std::uint32_t>(bytes, 44); ++i, offset += 56)
    answers.push_back({at<std::uint32_t>(bytes, offset), at<std::uint32_t>(bytes, offset + 4),
                       at<double>(bytes, offset + 8), at<float>(bytes, offset + 16)});
  if (acknowledges) client.say({{"type", "ack"}, {"seq", frame_seqs.back()}});
}

}  // namespace palpate::testing
