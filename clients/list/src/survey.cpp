// SPDX-License-Identifier: Apache-2.0
#include "survey.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <new>

#include "palpate/client/error.h"
#include "palpate/client/parameter_exchange.h"
#include "palpate/idl/error.h"
#include "palpate/idl/printable.h"
#include "palpate/rt/clock.h"

namespace palpate::list {
namespace {

// Of finite numbers only: its sender is not trusted.
std::array<double, 3> sizeOf(const dds::SurfaceMesh& mesh) {
  std::array<double, 3> size{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t i = axis; i < mesh.positions._length; i += 3) {
      low = std::min(low, mesh.positions._buffer[i]);
      high = std::max(high, mesh.positions._buffer[i]);
    }
    size[axis] = std::isfinite(high - low) ? high - low : 0.0;
  }
  return size;
}

Organ organOf(const dds::SurfaceMesh& mesh) {
  Organ organ{mesh.organ_id,
              mesh.session,
              dds::printable(mesh.model_id),
              mesh.positions._length / 3,
              mesh.triangles._length / 3,
              0,
              sizeOf(mesh),
              {}};
  for (std::size_t i = 0; i < mesh.accessible._length; ++i)
    organ.accessible += mesh.accessible._buffer[i] != 0 ? 1 : 0;
  constexpr std::size_t kMostRegions = 16;
  for (std::size_t i = 0; i < std::min<std::size_t>(kMostRegions, mesh.regions._length); ++i)
    organ.regions.push_back(
        {dds::printable(mesh.regions._buffer[i].name), mesh.regions._buffer[i].youngs_modulus});
  return organ;
}

void askForDevices(const dds::Participant& participant, std::chrono::milliseconds patience, Server& server) {
  dds::ParameterRequest question{};
  question.server_id = server.status.server_id;
  question.session = server.status.session;
  question.tool_id = dds::kAllTools;
  try {
    const auto answer = client::exchangeParameters(participant, question, patience);
    for (std::size_t tool = 0; tool < server.devices.size(); ++tool)
      server.devices[tool] = dds::printable(answer.tools[tool].device);
  } catch (const client::ClientError&) {  // it is listed all the same
  } catch (const dds::DdsError&) {        // likewise
  }
}

}  // namespace

bool isFor(const Publisher& publisher, const Server& server) {
  return publisher.sends && (publisher.server_id == server.status.server_id ||
                             (publisher.server_id == dds::kServerAny && server.status.answers_any));
}

Survey::Survey(const dds::Participant& participant)
    : participant_(participant),
      processes_(participant),
      statuses_(participant, nullptr, nullptr, dds::Wants::kHistory),
      poses_(participant, &Survey::onPose, this),
      surfaces_(participant, nullptr, this, &Survey::onSurface) {}

// DDS asks before it keeps a sample; what is to be said of it is noted here, and none is kept.
bool Survey::onSurface(const dds::SurfaceMesh& message, void* context) noexcept {
  auto& self = *static_cast<Survey*>(context);
  try {
    const std::lock_guard lock(self.mutex_);
    const bool known = std::any_of(self.organs_.begin(), self.organs_.end(), [&](const Organ& organ) {
      return organ.session == message.session && organ.organ_id == message.organ_id;
    });
    if (!known && self.organs_.size() < kMostOrgans) self.organs_.push_back(organOf(message));
  } catch (const std::bad_alloc&) {  // one less to tell of
  }
  return false;
}

void Survey::onPose(const dds::ToolPose& pose, dds::WriterId writer, void* context) noexcept {
  auto& self = *static_cast<Survey*>(context);
  const std::int64_t now_ns = rt::monotonicNow();
  try {
    const std::lock_guard lock(self.mutex_);
    const auto heard = std::find_if(self.heard_.begin(), self.heard_.end(), [&](const Heard& each) {
      return each.writer == writer && each.tool_id == pose.tool_id && each.server_id == pose.server_id;
    });
    if (heard != self.heard_.end()) {
      ++heard->poses;
      heard->last_ns = now_ns;
    } else if (self.heard_.size() < kMostPublishers) {
      self.heard_.push_back({pose.tool_id, pose.server_id, writer, 1, now_ns, now_ns});
    }
  } catch (const std::bad_alloc&) {  // one less to tell of
  }
}

std::vector<Publisher> Survey::publishers() const {
  std::vector<Heard> heard;
  {
    const std::lock_guard lock(mutex_);
    heard = heard_;
  }
  std::sort(heard.begin(), heard.end(), [](const Heard& a, const Heard& b) { return a.tool_id < b.tool_id; });
  const auto present = dds::writersOf(poses_.handle(), kMostPublishers);
  // One that ended meanwhile sends no more. Of too many the rest is not known.
  if (present.size() < kMostPublishers)
    std::erase_if(heard, [&](const Heard& each) {
      return std::find(present.begin(), present.end(), each.writer) == present.end();
    });
  std::vector<Publisher> found;
  for (const Heard& each : heard) {
    const double seconds = 1e-9 * static_cast<double>(each.last_ns - each.first_ns);
    const double rate = seconds > 0.0 ? static_cast<double>(each.poses - 1) / seconds : 0.0;
    found.push_back({true, each.tool_id, each.server_id, each.poses, rate,
                     processes_.processOf(poses_.handle(), each.writer)});
  }
  for (const dds::WriterId writer : present)
    if (std::none_of(heard.begin(), heard.end(), [&](const Heard& each) { return each.writer == writer; }))
      found.push_back({false, 0, 0, 0, 0.0, processes_.processOf(poses_.handle(), writer)});
  return found;
}

Listing Survey::listing(double patience_s) const {
  const std::chrono::milliseconds patience(static_cast<long>(1e3 * patience_s));
  Listing listing{participant_.domain(), {}, publishers()};
  for (const dds::ServerStatus& status : statuses_.running()) {
    Server server{status, {}, {}};
    {
      const std::lock_guard lock(mutex_);
      std::copy_if(organs_.begin(), organs_.end(), std::back_inserter(server.organs),
                   [&](const Organ& organ) { return organ.session == status.session; });
    }
    askForDevices(participant_, patience, server);
    listing.servers.push_back(std::move(server));
  }
  return listing;
}

std::string Survey::mismatch() const {
  const std::string of_status = statuses_.mismatch();
  return of_status.empty() ? surfaces_.mismatch() : of_status;
}

}  // namespace palpate::list
