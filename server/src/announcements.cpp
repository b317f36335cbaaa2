// SPDX-License-Identifier: Apache-2.0
#include "palpate/server/announcements.h"

#include <algorithm>
#include <vector>

#include "palpate/rt/clock.h"

namespace palpate::server {

Announcements::Announcements(const dds::Participant& participant, Channels& channels, const Facts& facts)
    : channels_(channels),
      server_id_(facts.server_id),
      answers_any_(facts.answers_any),
      tap_(participant, &Announcements::onSaid, this) {}

void Announcements::onSaid(const dds::ToolAnnouncement& said, dds::WriterId writer, void* context) noexcept {
  auto& self = *static_cast<Announcements*>(context);
  const bool ours =
      said.server_id == self.server_id_ || (self.answers_any_ && said.server_id == dds::kServerAny);
  if (ours && said.tool_id < kMaxTools && !self.book_.heard(said, writer))
    self.channels_.surplus_announcements.fetch_add(1, std::memory_order_relaxed);
}

Announcements::Owners Announcements::ownersOf(dds_entity_t poses) const {
  Owners owners;
  for (std::size_t tool = 0; tool < owners.size(); ++tool)
    if (const dds::WriterId writer = channels_.owners[tool].load(std::memory_order_relaxed); writer != 0)
      owners[tool] = dds::participantOf(poses, writer);
  return owners;
}

// Where there was no place for a word, at most once a second: it looks at all writers.
void Announcements::preferOwners(const Owners& owners, std::int64_t now_ns) {
  constexpr std::int64_t kPause = 1'000'000'000;
  const std::uint64_t surplus = channels_.surplus_announcements.load(std::memory_order_relaxed);
  if (surplus == surplus_ || now_ns - preferred_ns_ < kPause) return;
  surplus_ = surplus;
  preferred_ns_ = now_ns;
  std::vector<dds::WriterId> writers(tap_.matched());
  const dds_return_t count = dds_get_matched_publications(tap_.handle(), writers.data(), writers.size());
  writers.resize(std::min(writers.size(), static_cast<std::size_t>(std::max(count, 0))));
  std::erase_if(writers, [&](dds::WriterId writer) {
    const auto by = dds::participantOf(tap_.handle(), writer);
    return !by || std::find(owners.begin(), owners.end(), by) == owners.end();
  });
  book_.prefer(std::move(writers));
}

Announcements::ByTool Announcements::poll(dds_entity_t poses) {
  ByTool all;
  const std::vector<AnnouncementBook::Said> said = book_.said();
  if (said.empty()) return all;
  const Owners owners = ownersOf(poses);
  for (const AnnouncementBook::Said& one : said) {
    const auto by = dds::participantOf(tap_.handle(), one.writer);
    if (!by) book_.forget(one.writer);
    std::optional<DriverWord>& word = all[one.what.tool_id];
    if (by && by == owners[one.what.tool_id] && (!word || word->number < one.number))
      word = DriverWord{one.number, *by, one.what};
  }
  preferOwners(owners, rt::monotonicNow());
  return all;
}

}  // namespace palpate::server
