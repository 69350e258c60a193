// Who a client is: address blocks, PROXY headers, and how many places an address has.
#include <gtest/gtest.h>

#include "server/net/address_block.h"
#include "server/net/address_counts.h"
#include "server/net/proxy_header.h"

namespace pmesh {
namespace {

using boost::asio::ip::make_address;

TEST(AddressBlock, ContainsWhatSharesItsPrefix) {
  const auto contains = [](const char* block, const char* address) {
    return AddressBlock::parse(block).value().contains(make_address(address));
  };
  EXPECT_TRUE(contains("192.0.2.0/24", "192.0.2.255"));
  EXPECT_FALSE(contains("192.0.2.0/24", "192.0.3.0"));
  EXPECT_TRUE(contains("10.0.0.0/9", "10.127.1.1"));
  EXPECT_FALSE(contains("10.0.0.0/9", "10.128.1.1"));
  EXPECT_TRUE(contains("127.0.0.1", "127.0.0.1"));
  EXPECT_FALSE(contains("127.0.0.1", "127.0.0.2"));
  EXPECT_TRUE(contains("0.0.0.0/0", "8.8.8.8"));
  EXPECT_FALSE(contains("0.0.0.0/0", "2001:db8::1"));
  EXPECT_TRUE(contains("2001:db8::/33", "2001:db8:7fff::1"));
  EXPECT_FALSE(contains("2001:db8::/33", "2001:db8:8000::1"));
  EXPECT_TRUE(contains("192.0.2.0/24", "::ffff:192.0.2.7"));
  EXPECT_TRUE(contains("::1", "::1"));
}

TEST(AddressBlock, RefusesWhatIsNone) {
  for (const char* text : {"", "nonsense", "10.0.0.0/33", "10.0.0.0/", "10.0.0.0/-1", "10.0.0.1/24",
                           "::/129", "/8", "10.0.0/8", "2001:db8::1/64"}) {
    EXPECT_FALSE(AddressBlock::parse(text).ok()) << text;
  }
}

TEST(TrustedProxies, TheClientIsTheLastThatIsNoProxy) {
  const auto proxies = TrustedProxies::parse({"10.0.0.0/8", "127.0.0.1"}).value();
  const auto client = [&](const char* peer, const char* list) {
    return proxies.client_of(make_address(peer), list).to_string();
  };
  EXPECT_EQ(client("10.0.0.1", "203.0.113.9"), "203.0.113.9");
  EXPECT_EQ(client("10.0.0.1", "6.6.6.6, 203.0.113.9, 10.9.9.9"), "203.0.113.9");
  EXPECT_EQ(client("10.0.0.1", ""), "10.0.0.1");
  EXPECT_EQ(client("10.0.0.1", "203.0.113.9, nonsense"), "10.0.0.1");
  EXPECT_EQ(client("10.0.0.1", "203.0.113.9, nonsense, 10.0.0.2"), "10.0.0.2");
  EXPECT_EQ(client("8.8.8.8", "203.0.113.9"), "8.8.8.8");  // no proxy of ours: not believed
  EXPECT_EQ(client("10.0.0.1", "::ffff:203.0.113.9"), "203.0.113.9");
}

TEST(AddressCounts, GivesEachAddressItsPlaces) {
  AddressCounts counts(2);
  auto first = counts.enter(make_address("192.0.2.1"));
  auto second = counts.enter(make_address("::ffff:192.0.2.1"));
  EXPECT_TRUE(first && second);
  EXPECT_FALSE(counts.enter(make_address("192.0.2.1")));
  EXPECT_TRUE(counts.enter(make_address("192.0.2.2")));
  second.reset();
  EXPECT_TRUE(counts.enter(make_address("192.0.2.1")));
}

TEST(AddressCounts, TakesAnIpv6NetworkForOne) {
  AddressCounts counts(1);
  const auto first = counts.enter(make_address("2001:db8:0:1::1"));
  EXPECT_TRUE(first);
  EXPECT_FALSE(counts.enter(make_address("2001:db8:0:1:ffff::2")));
  EXPECT_TRUE(counts.enter(make_address("2001:db8:0:2::1")));
}

TEST(AddressCounts, ZeroIsAnyNumber) {
  AddressCounts counts(0);
  std::vector<AddressCounts::Slot> slots;
  for (int i = 0; i < 1000; ++i) slots.push_back(counts.enter(make_address("::1")).value());
}

std::string binary_header(unsigned char command, unsigned char family, const std::string& rest) {
  std::string header("\r\n\r\n\0\r\nQUIT\n", 12);
  header.push_back(static_cast<char>(0x20 | command));
  header.push_back(static_cast<char>(family));
  header.push_back(static_cast<char>(rest.size() >> 8));
  header.push_back(static_cast<char>(rest.size()));
  return header + rest;
}

struct ProxyCase {
  std::string bytes;
  ProxyHeader::Kind kind;
  std::string client;  // empty: none
};

const std::string kTcp4("\xCB\x00\x71\x09\x7F\x00\x00\x01\x30\x39\x1F\x90", 12);

TEST(ProxyHeader, ReadsBothVersions) {
  const std::string tcp6 = std::string("\x20\x01\x0d\xb8", 4) + std::string(32, '\0');
  for (const ProxyCase& test : {
           ProxyCase{"PROXY TCP4 203.0.113.9 127.0.0.1 1 2\r\n", ProxyHeader::header,
                     "203.0.113.9"},
           {"PROXY TCP6 2001:db8::1 ::1 1 2\r\n", ProxyHeader::header, "2001:db8::1"},
           {"PROXY UNKNOWN whatever\r\n", ProxyHeader::header, ""},
           {binary_header(1, 0x11, kTcp4), ProxyHeader::header, "203.0.113.9"},
           {binary_header(1, 0x11, kTcp4 + "and more"), ProxyHeader::header, "203.0.113.9"},
           {binary_header(1, 0x21, tcp6), ProxyHeader::header, "2001:db8::"},
           {binary_header(0, 0x11, kTcp4), ProxyHeader::header, ""},
           {binary_header(1, 0x00, ""), ProxyHeader::header, ""},
       }) {
    for (std::size_t cut = 1; cut < test.bytes.size(); ++cut) {
      EXPECT_EQ(parse_proxy_header(test.bytes.substr(0, cut)).kind, ProxyHeader::more) << cut;
    }
    const ProxyHeader header = parse_proxy_header(test.bytes + "GET / HTTP/1.1\r\n");
    EXPECT_EQ(header.kind, test.kind) << test.bytes;
    EXPECT_EQ(header.bytes, test.bytes.size());
    EXPECT_EQ(header.client ? header.client->to_string() : "", test.client);
  }
}

TEST(ProxyHeader, OtherBytesAreNone) {
  for (const char* bytes :
       {"GET / HTTP/1.1\r\n", "POST /", "PROXIES", "\x16\x03\x01", "\r\n\r\nGET"}) {
    EXPECT_EQ(parse_proxy_header(bytes).kind, ProxyHeader::none) << bytes;
  }
  EXPECT_EQ(parse_proxy_header("").kind, ProxyHeader::more);
}

TEST(ProxyHeader, BrokenOnesAreBad) {
  for (const std::string& bytes :
       {std::string("PROXY TCP4 nonsense 127.0.0.1 1 2\r\n"),
        std::string("PROXY TCP4 2001:db8::1 ::1 1 2\r\n"), std::string("PROXY UDP4 1.1.1.1\r\n"),
        "PROXY " + std::string(200, 'x'), binary_header(1, 0x11, "short"),
        binary_header(1, 0x21, kTcp4), binary_header(5, 0x11, kTcp4),
        binary_header(1, 0x11, std::string(5000, 'x'))}) {
    EXPECT_EQ(parse_proxy_header(bytes).kind, ProxyHeader::bad) << bytes;
  }
}

}  // namespace
}  // namespace pmesh
