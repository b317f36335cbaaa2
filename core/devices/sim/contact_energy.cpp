// SPDX-License-Identifier: Apache-2.0
#include "core/devices/sim/contact_energy.h"

#include <algorithm>

namespace palpate::device {
namespace {

AlongForce operator-(const AlongForce& a, const AlongForce& b) noexcept {
  return {a.work - b.work, a.damped - b.damped, a.speed_squared - b.speed_squared};
}

void add(const AlongForce& more, AlongForce& sum) noexcept {
  sum.work += more.work;
  sum.damped += more.damped;
  sum.speed_squared += more.speed_squared;
}

// The contact whose first force is that of entry `first`, above 0.
ContactEnergy contactFrom(const Trace& trace, std::size_t first) {
  ContactEnergy contact;
  contact.first = contact.last = first;
  for (std::size_t i = first; i < trace.force.size() && !(length(trace.force[i]) < kLeastForce); ++i) {
    contact.last = i;
    contact.largest_force = std::max(contact.largest_force, length(trace.force[i]));
    contact.stalled = contact.stalled || (i < trace.stalled.size() && trace.stalled[i]);
  }
  contact.along = trace.energy[contact.last] - trace.energy[first - 1];
  return contact;
}

}  // namespace

const ContactEnergy* EnergyVerdict::worst() const noexcept {
  const ContactEnergy* worst = nullptr;
  for (const ContactEnergy& contact : contacts)
    if (!contact.stalled && (worst == nullptr || !(contact.excess() <= worst->excess()))) worst = &contact;
  return worst;
}

bool EnergyVerdict::holds() const noexcept {
  return std::all_of(contacts.begin(), contacts.end(),
                     [](const ContactEnergy& contact) { return contact.stalled || contact.holds(); });
}

EnergyVerdict judgeEnergy(const Trace& trace) {
  EnergyVerdict verdict;
  for (std::size_t i = 1; i < trace.force.size(); ++i) {
    if (length(trace.force[i]) < kLeastForce) continue;
    const ContactEnergy contact = contactFrom(trace, i);
    i = contact.last;
    if (contact.last + 1 == trace.force.size()) break;  // the organ may still give back what it holds
    add(contact.along, contact.stalled ? verdict.stalled : verdict.judged);
    verdict.stalls += contact.stalled ? 1 : 0;
    verdict.contacts.push_back(contact);
  }
  return verdict;
}

}  // namespace palpate::device
