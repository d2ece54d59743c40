// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "plugin/snapshot/btFemEnvelope.h"

#include "LinearMath/btScalar.h"

using namespace bullet_fem;

namespace
{

constexpr std::uint32_t kVersion = 18;  // raised at each change of the format
constexpr std::uint32_t kByteOrder = 0x01020304, kOtherByteOrder = 0x04030201;
constexpr std::array<char, 8> kMagic = {'B', 'u', 'l', 'l', 'F', 'E', 'M', '\n'};

struct Header
{
    std::array<char, 8> m_magic = kMagic;
    std::uint32_t m_byteOrder = kByteOrder;
    std::uint32_t m_version = kVersion;
    std::uint32_t m_scalarBytes = sizeof(btScalar);
    btFemContents m_contents = btFemContents::state;
    std::uint64_t m_size = 0;  // size of the contents [B]
    std::uint64_t m_mark = 0;  // checksum of the contents
};
static_assert(sizeof(Header) == 40, "no padding: it is copied as it is");

const char* nameOf(btFemContents contents)
{
    if (contents == btFemContents::world) return "the state of a world";
    return contents == btFemContents::state ? "a saved state" : "a body's definition";
}

}  // namespace

void beginEnvelope(std::vector<unsigned char>& buffer, btFemContents contents)
{
    Header header;
    header.m_contents = contents;
    buffer.clear();
    ByteWriter(buffer).raw(&header, sizeof header);
}

void closeEnvelope(std::vector<unsigned char>& buffer)
{
    Header header;
    std::memcpy(&header, buffer.data(), sizeof header);
    header.m_size = buffer.size() - sizeof header;
    header.m_mark = markOfBytes(buffer.data() + sizeof header, buffer.size() - sizeof header);
    std::memcpy(buffer.data(), &header, sizeof header);
}

ByteReader openEnvelope(const unsigned char* data, std::size_t size, btFemContents contents)
{
    Header header;
    if (!data || size < sizeof header) reject("it has ", data ? size : 0, " bytes, not even its header's 40");
    std::memcpy(&header, data, sizeof header);
    if (header.m_magic != kMagic) reject("it is something else: it does not begin with BullFEM");
    if (header.m_byteOrder == kOtherByteOrder) reject("it was written by a machine of the other byte order");
    if (header.m_byteOrder != kByteOrder) reject("its header is damaged");
    if (header.m_version != kVersion)
        reject("it is of version ", header.m_version, ", and this library reads version ", kVersion,
               "; save it anew with this one");
    if (header.m_scalarBytes != sizeof(btScalar))
        reject("it was written with a btScalar of ", header.m_scalarBytes, " bytes; here it has ", sizeof(btScalar));
    if (header.m_contents != contents) reject("it is not ", nameOf(contents));
    if (header.m_size != size - sizeof header)
        reject("it is cut off or too long: ", size - sizeof header, " bytes follow the header, which tells of ",
               header.m_size);
    data += sizeof header;
    size -= sizeof header;
    if (header.m_mark != markOfBytes(data, size)) reject("it is damaged: its checksum is another");
    return {data, size};
}
