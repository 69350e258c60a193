// How many of something each client address has under way: connections, requests behind a proxy,
// levels of detail.
#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <unordered_map>

#include <boost/asio/ip/address.hpp>

namespace pmesh {

/// An IPv6 address counts by its first 64 bits: whoever has one has all of those. Memory: what is
/// under way, which other limits bound. Threads: all members may be called at once;
/// slots must not outlive the counts.
class AddressCounts {
 public:
  /// `most` for each address; 0: any number.
  explicit AddressCounts(std::size_t most) : most_(most) {}
  AddressCounts(const AddressCounts&) = delete;
  AddressCounts& operator=(const AddressCounts&) = delete;

  /// One thing under way, for as long as it exists.
  class Slot {
   public:
    Slot() = default;
    Slot(Slot&& other) noexcept : counts_(other.counts_), key_(other.key_) {
      other.counts_ = nullptr;
    }
    Slot& operator=(Slot&& other) noexcept {
      std::swap(counts_, other.counts_);
      std::swap(key_, other.key_);
      return *this;
    }
    ~Slot() {
      if (counts_ != nullptr) counts_->leave(key_);
    }

   private:
    friend AddressCounts;
    Slot(AddressCounts* counts, boost::asio::ip::address key) : counts_(counts), key_(key) {}

    AddressCounts* counts_ = nullptr;
    boost::asio::ip::address key_;
  };

  /// Nothing if the address has all that it may have. Throws std::bad_alloc.
  std::optional<Slot> enter(const boost::asio::ip::address& address);

 private:
  struct Hash {
    std::size_t operator()(const boost::asio::ip::address& address) const;
  };

  void leave(const boost::asio::ip::address& key);

  const std::size_t most_;
  std::mutex mutex_;
  std::unordered_map<boost::asio::ip::address, std::size_t, Hash> counts_;
};

}  // namespace pmesh
