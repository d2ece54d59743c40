// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "bullet_fem/io/urdf_robot.h"
#include "io/temporary_folder.h"

namespace bullet_fem
{
namespace
{

using testing::AllOf;
using testing::HasSubstr;

const std::string kArm =
    "<link name='hand'><inertial><origin xyz='0 0 .1'/><mass value='2'/>"
    "<inertia ixx='1' ixy='.5' ixz='0' iyy='2' iyz='0' izz='3'/></inertial>"
    "<collision><origin xyz='0 0 .2' rpy='0 1.5 0'/><geometry><box size='.1 .2 .3'/></geometry></collision>"
    "<collision><geometry><mesh filename='hand.stl' scale='2 2 2'/></geometry></collision>"
    "<contact><lateral_friction value='.9'/></contact><visual/><sensor/></link>"
    "<link name='base'/>"
    "<link name='arm'><collision><geometry><capsule radius='.05' length='.4'/></geometry></collision></link>"
    "<joint name='wrist' type='prismatic'><parent link='arm'/><child link='hand'/><axis xyz='0 0 2'/>"
    "<limit lower='-.1' upper='.2' effort='30' velocity='2'/><dynamics damping='.3'/></joint>"
    "<joint name='shoulder' type='continuous'><parent link='base'/><child link='arm'/><origin xyz='1 2 3' rpy='.1 .2 "
    ".3'/>"
    "<mimic joint='wrist'/></joint><gazebo/>";

class UrdfRobotReader : public ::testing::Test
{
protected:
    UrdfRobotReader()
    {
        m_folder.write("hand.stl", "not read here");
        m_folder.write("pad.vtk", "not read here");
    }
    UrdfRobot read(const std::string& content)
    {
        return readUrdfRobot(m_folder.write("robot.urdf", "<robot name='r2'>\n" + content + "\n</robot>\n"));
    }
    std::string complaint(const std::string& content)
    {
        return messageOf<std::runtime_error>([&] { read(content); });
    }

    TemporaryFolder m_folder;
};

TEST_F(UrdfRobotReader, TakesLinksBehindTheirParents)
{
    const UrdfRobot robot = read(kArm);
    EXPECT_EQ(robot.m_name, "r2");
    ASSERT_EQ(robot.m_links.size(), 3u);
    EXPECT_EQ(robot.m_links[0].m_name, "base");
    EXPECT_EQ(robot.m_links[1].m_name, "arm");
    ASSERT_EQ(robot.m_joints.size(), 2u);
    for (int k = 0; k < 2; ++k)
    {
        EXPECT_EQ(robot.m_joints[std::size_t(k)].m_parent, k);
        EXPECT_EQ(robot.m_joints[std::size_t(k)].m_child, k + 1);
    }
    EXPECT_EQ(robot.m_joints[0].m_kind, UrdfJoint::Kind::continuous);
    EXPECT_EQ(robot.m_joints[0].m_pose.m_position.z, 3);
    EXPECT_EQ(robot.m_joints[0].m_pose.m_turn.y, 0.2);
    EXPECT_TRUE(std::isinf(robot.m_joints[0].m_upper));
}

TEST_F(UrdfRobotReader, TakesEveryValueOfALinkAndItsJoint)
{
    const UrdfRobot robot = read(kArm);
    const UrdfLink& hand = robot.m_links[2];
    EXPECT_EQ(hand.m_mass, 2);
    EXPECT_EQ(hand.m_inertial.m_position.z, 0.1);
    EXPECT_EQ(hand.m_inertia, (std::array<double, 6>{1, 0.5, 0, 2, 0, 3}));
    EXPECT_EQ(hand.m_friction, 0.9);
    ASSERT_EQ(hand.m_collisions.size(), 2u);
    EXPECT_EQ(hand.m_collisions[0].m_size.y, 0.2);
    EXPECT_EQ(hand.m_collisions[0].m_pose.m_turn.y, 1.5);
    EXPECT_EQ(hand.m_collisions[1].m_kind, UrdfShape::Kind::hull);
    EXPECT_EQ(hand.m_collisions[1].m_size.x, 2);
    EXPECT_THAT(hand.m_collisions[1].m_meshPath, HasSubstr("hand.stl"));
    EXPECT_EQ(robot.m_links[1].m_collisions[0].m_length, 0.4);
    const UrdfJoint& wrist = robot.m_joints[1];
    EXPECT_EQ(wrist.m_axis.z, 1);
    EXPECT_EQ(wrist.m_lower, -0.1);
    EXPECT_EQ(wrist.m_upper, 0.2);
    EXPECT_EQ(wrist.m_effort, 30);
    EXPECT_EQ(wrist.m_velocity, 2);
    EXPECT_EQ(wrist.m_damping, 0.3);
}

TEST_F(UrdfRobotReader, NotesWhatItLeavesOut)
{
    EXPECT_THAT(read(kArm).m_notes,
                testing::UnorderedElementsAre(HasSubstr("<sensor> of <link>"), HasSubstr("<mimic> of <joint>"),
                                              HasSubstr("<gazebo> of <robot>")));
}

TEST_F(UrdfRobotReader, TakesSoftPartsWithTheirAttachments)
{
    const std::string pad =
        "<deformable name='pad'><origin xyz='0 1 0'/><inertial><mass value='.1'/></inertial><visual "
        "filename='pad.vtk'/>"
        "<attach link='hand' box='1 0 0 -1 2 3'/><attach link='arm' box='0 0 0 1 1 1'/></deformable>";
    const UrdfRobot robot = read(kArm + pad + pad);
    ASSERT_EQ(robot.m_softParts.size(), 2u);
    EXPECT_EQ(robot.m_softParts[0].m_body.m_mass, 0.1);
    EXPECT_EQ(robot.m_softParts[0].m_pose.m_position.y, 1);
    ASSERT_EQ(robot.m_softParts[0].m_attachments.size(), 2u);
    EXPECT_EQ(robot.m_softParts[0].m_attachments[0].m_link, 2);
    EXPECT_EQ(robot.m_softParts[0].m_attachments[0].m_low.x, -1);
    EXPECT_EQ(robot.m_softParts[0].m_attachments[0].m_high.x, 1);
    EXPECT_THAT(complaint(kArm + "<deformable name='p'><inertial><mass value='1'/></inertial><visual "
                                 "filename='pad.vtk'/><attach link='nose' box='0 0 0 1 1 1'/></deformable>"),
                HasSubstr("there is no link 'nose'"));
}

TEST_F(UrdfRobotReader, NamesLineAndFault)
{
    const std::string links = "<link name='a'/><link name='b'/>\n";
    const auto joint = [&](const std::string& type, const std::string& more)
    { return links + "<joint name='j' type='" + type + "'><parent link='a'/><child link='b'/>" + more + "</joint>"; };
    EXPECT_THAT(complaint(""), HasSubstr("no <link>"));
    EXPECT_THAT(complaint(links), HasSubstr("2 links without a parent"));
    EXPECT_THAT(complaint("<link name='a'/><link name='a'/>"), HasSubstr("two links 'a'"));
    EXPECT_THAT(complaint(joint("floating", "")), AllOf(HasSubstr("line 3"), HasSubstr("type is 'floating'")));
    EXPECT_THAT(complaint(joint("revolute", "")), HasSubstr("a <limit> is missing"));
    EXPECT_THAT(complaint(joint("revolute", "<limit lower='2' upper='1'/>")), HasSubstr("above upper"));
    EXPECT_THAT(complaint(joint("continuous", "<axis xyz='0 0 0'/>")), HasSubstr("xyz is 0"));
    EXPECT_THAT(complaint(joint("continuous", "<axis xyz='0 0'/>")), HasSubstr("3 numbers"));
    EXPECT_THAT(complaint(joint("continuous", "<axis xyz='0 0 nan'/>")), HasSubstr("finite"));
    EXPECT_THAT(
        complaint(joint("fixed", "") + "<joint name='k' type='fixed'><parent link='b'/><child link='b'/></joint>"),
        HasSubstr("its child"));
    EXPECT_THAT(
        complaint(joint("fixed", "") + "<joint name='k' type='fixed'><parent link='b'/><child link='a'/></joint>"),
        HasSubstr("0 links without a parent"));
    EXPECT_THAT(complaint("<link name='a'><collision><geometry><cone/></geometry></collision></link>"),
                HasSubstr("it must be a <box>"));
    EXPECT_THAT(complaint("<link name='a'><collision><geometry><sphere radius='0'/></geometry></collision></link>"),
                HasSubstr("a number above 0"));
    EXPECT_THAT(complaint("<link name='a'><inertial><mass value='-1'/></inertial></link>"), HasSubstr("at least 0"));
    EXPECT_THAT(
        complaint("<link name='a'><collision><geometry><mesh filename='no.stl'/></geometry></collision></link>"),
        HasSubstr("no.stl"));
    EXPECT_THAT(complaint(links + "<joint name='j' type='fixed'><parent link='a'/></joint>"), HasSubstr("<child link"));
}

}  // namespace
}  // namespace bullet_fem
