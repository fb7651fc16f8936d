// Replaces the two functions with which mutexes are locked.
#include "live/lock_counter.hpp"

#include <cstdint>
#include <cstdlib>  // __GLIBC__

#ifdef __GLIBC__
#include <dlfcn.h>
#include <pthread.h>

namespace {

constinit thread_local std::uint64_t locks = 0;

using Lock = int (*)(pthread_mutex_t*);

int call_next(const char* name, Lock& next, pthread_mutex_t* mutex) noexcept {
  ++locks;
  if (next == nullptr) next = reinterpret_cast<Lock>(dlsym(RTLD_NEXT, name));
  return next(mutex);
}

}  // namespace

extern "C" int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  static Lock next = nullptr;
  return call_next("pthread_mutex_lock", next, mutex);
}
extern "C" int pthread_mutex_trylock(pthread_mutex_t* mutex) noexcept {
  static Lock next = nullptr;
  return call_next("pthread_mutex_trylock", next, mutex);
}

std::uint64_t test::locks_of_thread() noexcept {
  return locks;
}
#else
std::uint64_t test::locks_of_thread() noexcept {
  return 0;
}
#endif
