#include "tests/fuzz/allocation_meter.h"

#include <algorithm>
#include <cstdlib>
#include <new>

#include <malloc.h>

namespace {

std::size_t now = 0, peak = 0;

}  // namespace

namespace pmesh {

std::size_t allocated_bytes() { return now; }
std::size_t peak_bytes() { return peak; }
void restart_peak() { peak = now; }

}  // namespace pmesh

void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  void* block = std::malloc(std::max<std::size_t>(1, size));
  if (block == nullptr) return nullptr;
  now += malloc_usable_size(block);
  peak = std::max(peak, now);
  return block;
}
void* operator new(std::size_t size) {
  void* block = operator new(size, std::nothrow);
  if (block == nullptr) throw std::bad_alloc();
  return block;
}
void* operator new[](std::size_t size) { return operator new(size); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
  return operator new(size, std::nothrow);
}

void operator delete(void* block) noexcept {
  if (block == nullptr) return;
  now -= malloc_usable_size(block);
  std::free(block);
}
void operator delete(void* block, std::size_t) noexcept { operator delete(block); }
void operator delete(void* block, const std::nothrow_t&) noexcept { operator delete(block); }
void operator delete[](void* block) noexcept { operator delete(block); }
void operator delete[](void* block, std::size_t) noexcept { operator delete(block); }
void operator delete[](void* block, const std::nothrow_t&) noexcept { operator delete(block); }
