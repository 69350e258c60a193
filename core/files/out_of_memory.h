// The edge where exceptions for want of memory end: below, containers throw; above, errors are
// values.
#pragma once

#include <new>
#include <stdexcept>
#include <utility>

#include "core/base/result.h"

namespace pmesh {

/// What `work` returns, a Result; or out_of_resources if memory for it could not be had.
template <class Work>
auto catching_out_of_memory(Work&& work) -> decltype(work()) {
  try {
    return std::forward<Work>(work)();
  } catch (const std::bad_alloc&) {
    return Error{ErrorCode::out_of_resources, "out of memory"};
  } catch (const std::length_error&) {
    return Error{ErrorCode::out_of_resources, "out of memory"};
  }
}

}  // namespace pmesh
