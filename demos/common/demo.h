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
constexpr double kDemoStep = 1.0 / 60;  ///< default step of the demos [s]

/// A Bullet vector from doubles, in either precision.
inline btVector3 at(double x, double y, double z)
{
    return {btScalar(x), btScalar(y), btScalar(z)};
}

/// Framework of all demos: options, a clock, pictures and the final verdict. A demo declares its options and passes its
/// scene to `run`; the scene calls `step` until that returns false, and then reports results.
class Demo
{
public:
    /// `what` is shown by --help; `seconds` [s] is the default duration of the scene, which --seconds changes.
    Demo(const std::string& name, const std::string& what, double seconds);
    ~Demo();
    Demo(const Demo&) = delete;
    Demo& operator=(const Demo&) = delete;

    /// Declares an option with its default in `value`, limited to [low, high]. Call before `run`.
    void option(const std::string& name, double& value, double low, double high, const std::string& what);
    /// Declares a flag that sets `value`. Call before `run`.
    void flag(const std::string& name, bool& value, const std::string& what);
    /// Declares an option for a file name. Call before `run`.
    void option(const std::string& name, std::string& value, const std::string& what);

    /// Reads the command line and runs the scene. Returns the program's exit code: 0 if all checks held, 1 if a check
    /// failed or an exception was thrown, 2 on an invalid option.
    int run(int argc, char** argv, const std::function<void()>& scene);

    // For the scene:

    /// Sets the camera's position and target [m]; allowed at any time.
    void look(const btVector3& eye, const btVector3& target, double fieldOfView = 0.6);
    /// Sets an object's colour in pictures (sRGB) in place of the default.
    void paint(const btCollisionObject& object, const Vec3& colour);
    /// Also draws the objects of another world, which the scene steps; null: of none.
    void drawBeside(const btDynamicsWorld* world);
    /// Steps the world by `h` [s] and draws pictures that are due. Returns false, without a step, when the time is
    /// over.
    bool step(btDynamicsWorld& world, double h = kDemoStep);
    double time() const { return m_time; }        ///< simulated time so far [s]
    double seconds() const { return m_seconds; }  ///< duration of the simulation [s]

    /// Adds a line to the final table.
    void figure(const std::string& what, double value, const std::string& unit);
    /// Adds a line that fails the demo if `value` is outside [low, high]. The line is omitted if the run ended before
    /// the time `from` [s].
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
    double m_stepSeconds = 0;  // total processor time of all steps
};

}  // namespace bullet_fem
