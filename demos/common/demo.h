// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "BulletSoftBody/btSoftBody.h"
#include "btBulletDynamicsCommon.h"
#include "bullet_fem/btFemSoftBodySolver.h"
#include "bullet_fem/fem/common/vec3.h"

namespace CLI
{
class App;
}

namespace bullet_fem
{

class DemoFilm;

constexpr double kGravity = 9.81;       ///< of all demos, along -y [m/s2]
constexpr double kDemoStep = 1.0 / 60;  ///< of the demos, unless they choose another [s]

/// A Bullet vector of doubles, in either precision.
inline btVector3 at(double x, double y, double z)
{
    return {btScalar(x), btScalar(y), btScalar(z)};
}

/// What all demos have besides their scene: options, a clock, pictures and the verdict at the end. A demo declares its
/// options, and hands its scene to `run`; the scene calls `step` until that is false, and then says what it found.
class Demo
{
public:
    /// `what` is shown by --help; `seconds` [s] is how long the scene lasts unless --seconds says otherwise.
    Demo(const std::string& name, const std::string& what, double seconds);
    ~Demo();
    Demo(const Demo&) = delete;
    Demo& operator=(const Demo&) = delete;

    /// An option with its default in `value`, which must be in [low, high]. Before `run`.
    void option(const std::string& name, double& value, double low, double high, const std::string& what);
    /// A switch, which sets `value` and takes no argument. Before `run`.
    void flag(const std::string& name, bool& value, const std::string& what);
    /// A file's name.
    void option(const std::string& name, std::string& value, const std::string& what);

    /// Reads the command line and plays the scene. Returns the program's exit code: 0 if all checks held, 1 if one did
    /// not or an exception came, 2 on a bad option.
    int run(int argc, char** argv, const std::function<void()>& scene);

    // For the scene.

    /// Where the camera stands and what it looks at [m]; at any time.
    void look(const btVector3& eye, const btVector3& target, double fieldOfView = 0.6);
    /// The colour of an object in pictures (sRGB), in place of the usual one.
    void paint(const btCollisionObject& object, const Vec3& colour);
    /// Steps the world by `h` [s], unless the time is over: then false. Pictures are drawn where their time has come.
    bool step(btDynamicsWorld& world, double h = kDemoStep);
    double time() const { return m_time; }        ///< simulated so far [s]
    double seconds() const { return m_seconds; }  ///< to simulate [s]

    /// A line of the table at the end.
    void figure(const std::string& what, double value, const std::string& unit);
    /// A line that fails the demo where `value` is not in [low, high]. It is left out where the run ended before `from`
    /// [s], the time that it needs.
    void check(const std::string& what, double value, double low, double high, const std::string& unit,
               double from = 0);

private:
    void printTable() const;

    std::string m_name;
    double m_seconds, m_time = 0;
    std::string m_folder;
    std::unique_ptr<CLI::App> m_options;
    std::unique_ptr<DemoFilm> m_film;
    std::vector<std::string> m_lines, m_checks;
    bool m_failed = false;
    int m_steps = 0, m_tets = 0;
    double m_stepSeconds = 0;  // of processor time, in all steps
};

}  // namespace bullet_fem
