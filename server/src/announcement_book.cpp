// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/announcement_book.h"

#include <algorithm>
#include <cstring>

namespace palpate::server {
namespace {

// Bits are compared, so that a NaN that is repeated is nothing new.
bool same(const dds::ToolAnnouncement& a, const dds::ToolAnnouncement& b) noexcept {
  const auto equal = [](double x, double y) { return std::memcmp(&x, &y, sizeof x) == 0; };
  return a.server_id == b.server_id && std::strncmp(a.device, b.device, sizeof a.device) == 0 &&
         equal(a.device_force_limit, b.device_force_limit) && a.has_tip_radius == b.has_tip_radius &&
         equal(a.tip_radius, b.tip_radius) && a.fields == b.fields &&
         std::memcmp(&a.values, &b.values, sizeof a.values) == 0;
}

}  // namespace

bool AnnouncementBook::heard(const dds::ToolAnnouncement& what, dds::WriterId writer) noexcept {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock) return true;
  Said* const at = place(what, writer);
  if (at == nullptr) return false;
  if (at->writer == writer && at->what.tool_id == what.tool_id && same(at->what, what)) return true;
  *at = {writer, ++heard_, what};
  return true;
}

AnnouncementBook::Said* AnnouncementBook::place(const dds::ToolAnnouncement& what,
                                                dds::WriterId writer) noexcept {
  Said* room = nullptr;
  for (Said& one : said_) {
    if (one.writer == writer && one.what.tool_id == what.tool_id) return &one;
    if (room == nullptr && one.writer == 0) room = &one;
  }
  if (room != nullptr || !isPreferred(writer)) return room;
  const auto other =
      std::find_if(said_.begin(), said_.end(), [&](const Said& one) { return !isPreferred(one.writer); });
  return other == said_.end() ? nullptr : &*other;
}

bool AnnouncementBook::isPreferred(dds::WriterId writer) const noexcept {
  return std::find(preferred_.begin(), preferred_.end(), writer) != preferred_.end();
}

std::vector<AnnouncementBook::Said> AnnouncementBook::said() const {
  const std::lock_guard lock(mutex_);
  std::vector<Said> all;
  std::copy_if(said_.begin(), said_.end(), std::back_inserter(all),
               [](const Said& one) { return one.writer != 0; });
  return all;
}

void AnnouncementBook::forget(dds::WriterId writer) {
  const std::lock_guard lock(mutex_);
  for (Said& one : said_)
    if (one.writer == writer) one = Said{};
}

void AnnouncementBook::prefer(std::vector<dds::WriterId> writers) {
  const std::lock_guard lock(mutex_);
  preferred_ = std::move(writers);
}

}  // namespace palpate::server
