// SPDX-License-Identifier: Apache-2.0
// Loaded before all other libraries of palpate-server (LD_PRELOAD): the tick, DDS's receive threads, or one that sends by DDS, wait for
// as long as they are told to, as at a lock that nobody gives back.
#include "stuck_thread.h"

#include <dlfcn.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/socket.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string_view>

namespace palpate::faults {
namespace {

using Post = int(sem_t*);
using Receive = ssize_t(int, msghdr*, int);
using Send = ssize_t(int, const msghdr*, int);

Post* next_post = nullptr;
Receive* next_receive = nullptr;
Send* next_send = nullptr;
std::string_view victim;
std::atomic<bool> stuck{false};

template <class Function>
void find(const char* name, Function*& next) noexcept {
  void* const found = dlsym(RTLD_NEXT, name);
  static_assert(sizeof found == sizeof next);
  std::memcpy(&next, &found, sizeof found);
}

void onSignal(int signal) {
  stuck.store(signal == SIGUSR2);
}

// Before main().
__attribute__((constructor)) void prepare() noexcept {
  find("sem_post", next_post);
  find("recvmsg", next_receive);
  find("sendmsg", next_send);
  if (const char* const wanted = std::getenv(kStuckVariable)) victim = wanted;
  std::signal(SIGUSR1, onSignal);
  std::signal(SIGUSR2, onSignal);
}

void waitIfStuck() noexcept {
  if (!stuck.load() || victim.empty()) return;
  char name[16] = {};
  pthread_getname_np(pthread_self(), name, sizeof name);
  if (std::string_view(name).substr(0, victim.size()) != victim) return;
  constexpr timespec kAgain{0, 100'000'000};  // rarely: a thread at a lock does not run
  while (stuck.load()) nanosleep(&kAgain, nullptr);
}

}  // namespace
}  // namespace palpate::faults

extern "C" int sem_post(sem_t* semaphore) noexcept {
  using namespace palpate::faults;
  if (next_post == nullptr) prepare();
  waitIfStuck();
  return next_post(semaphore);
}

extern "C" ssize_t recvmsg(int socket, msghdr* message, int flags) {
  using namespace palpate::faults;
  if (next_receive == nullptr) prepare();
  waitIfStuck();
  return next_receive(socket, message, flags);
}

extern "C" ssize_t sendmsg(int socket, const msghdr* message, int flags) {
  using namespace palpate::faults;
  if (next_send == nullptr) prepare();
  waitIfStuck();
  return next_send(socket, message, flags);
}
