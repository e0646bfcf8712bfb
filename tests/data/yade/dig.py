# Digs of a scene of config/scenes by YADE: see make.sh, which runs this, and README.md for the laws and what stands for what.
#   yade -n -x -j1 dig.py check SCENE.yaml -           a grain on a plate, two grains that meet
#   yade -n -x -j1 dig.py bed SCENE.yaml BED            a bed, poured and levelled, into BED
#   yade -n -x -j1 dig.py TRAJECTORY SCENE.yaml BED     that bed dug: a force recording on BED__TRAJECTORY.csv
# The environment: FRICTION, ROLLING, DENSITY of the gravel, SEED; and where they are not the scene's BUCKET (friction and
# rolling friction), SLOPE_DEG, ROCK_M (radius), STEPS (per 5 ms), YOUNG_PA.
import math
import os
import sys
import yaml

task, scene_file, bed_file = sys.argv[-3:]
scene = yaml.safe_load(open(scene_file))
value = lambda name, default=0: float(os.environ.get(name) or default)
friction, rolling, density = value('FRICTION', .5), value('ROLLING', .5), value('DENSITY', 2500)
material, packing, box_m = scene['material'], scene['packing'], scene['box_m']
radius = material['diameter_m'] / 2
(x0, x1), (y0, y1), (z0, top) = (map(float, box_m[axis]) for axis in 'xyz')
bed = scene.get('bed', {})
steel = value('BUCKET', (bed.get('pairs') or [{'friction': 0}])[0]['friction'])
periodic = bed.get('periodic_y', False)
young_at = material.get('young_at_kgpm3')
young = value('YOUNG_PA', float(material['young_Pa']) * (density / young_at if young_at else 1))
window_s = .005
steps = int(value('STEPS', 35))
stride = 5  # steps between readings of the bucket
mass = density * 4 / 3 * math.pi * radius**3

# The spring that LIGGGHTS' `hooke` makes of E: as much energy as Hertz's at the characteristic speed.
stiff = young / (2 * (1 - material['poisson']**2))
reduced = 16 * math.sqrt(radius / 2) * stiff
spring_Npm = reduced / 15 * (15 * mass / 2 * material['characteristic_velocity_mps']**2 / reduced)**.2

# YADE's local damping, the only one of its law: two spheres part at sqrt((1 - damping) / (1 + damping)) of their speed.
# The scenes' restitution of .2 would take .92, by which a grain falls at .08 g. Damping also drags what moves and trembles:
# little of it, then, for digs. Beds of the rig hold 7452 grains poured with .1 and 6795 with .4; LIGGGHTS' hold 7035.
damping = value('DAMPING', .3 if task == 'bed' else .1)
shear = 1  # shear over normal stiffness, as in LIGGGHTS' hooke and ours


def materials():
    for label, mu, roll in ('gravel', friction, rolling), ('bucket', steel or friction, steel or rolling):
        O.materials.append(CohFrictMat(label=label, young=spring_Npm / radius, poisson=shear, density=density,
                                       frictionAngle=math.atan(mu), isCohesive=False, momentRotationLaw=True,
                                       alphaKr=.25, alphaKtw=0, etaRoll=roll / 2))


def engines():
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Facet_Aabb(), Bo1_Box_Aabb()], verletDist=.1 * radius),
        InteractionLoop([Ig2_Sphere_Sphere_ScGeom6D(), Ig2_Facet_Sphere_ScGeom6D(), Ig2_Box_Sphere_ScGeom6D()],
                        [Ip2_CohFrictMat_CohFrictMat_CohFrictPhys()],
                        [Law2_ScGeom6D_CohFrictPhys_CohesionMoment(always_use_moment_law=True, useIncrementalForm=True)]),
        PyRunner(command='roll_on_walls()', iterPeriod=50),
        PyRunner(command='read_bucket()', iterPeriod=stride, label='reader', dead=True),
        TranslationEngine(label='slide', dead=True),
        RotationEngine(rotationAxis=(0, -1, 0), rotateAroundZero=True, label='turn', dead=True),
        NewtonIntegrator(gravity=(0, 0, -scene['gravity_mps2']), damping=damping),
    ]
    O.dt = window_s / steps


def limit_rolling(interaction, roll):  # on a plate, R* is the grain's radius, twice that of two grains
    interaction.phys.maxRollPl = roll * radius


def walls():  # in a periodic cell in strips, as no body may be wider than half of it
    thick, high = .05, .45
    strips = 3 if periodic else 1
    half = (y1 - y0) / 2 / strips
    sides = []
    for y in (y0 + (2 * n + 1) * half for n in range(strips)):
        sides += [(((x0 + x1) / 2, y, z0 - thick), ((x1 - x0) / 2 + 2 * thick, half, thick)),
                  ((x0 - thick, y, z0 + high), (thick, half, high)), ((x1 + thick, y, z0 + high), (thick, half, high))]
    if not periodic:
        across = (x1 - x0) / 2 + 2 * thick
        sides += [(((x0 + x1) / 2, y, z0 + high), (across, thick, high)) for y in (y0 - thick, y1 + thick)]
    return [O.bodies.append(box(centre, half, fixed=True, material='gravel')) for centre, half in sides]


def roll_on_walls():
    for wall in wall_ids:
        for interaction in O.bodies[wall].intrs():
            if interaction.isReal:
                limit_rolling(interaction, rolling)


def settle(seconds):
    O.run(round(seconds / O.dt), True)


def pour():
    loose = packing['solid_fraction'] / 1.2  # makeCloud gives up at the scene's
    column = z0 + (top - z0) * packing['fill_factor'] / loose
    count = round(packing['fill_factor'] * (x1 - x0) * (y1 - y0) * (top - z0) / (4 / 3 * math.pi * radius**3))
    from yade import pack
    cloud = pack.SpherePack()
    if cloud.makeCloud((x0, y0, z0), (x1, y1, column), rMean=radius, rRelFuzz=0, num=count, seed=int(value('SEED', 1))) != count:
        raise RuntimeError('the column does not hold its grains')
    cloud.toSimulation(material='gravel')
    for body in O.bodies:
        if isinstance(body.shape, Sphere):
            body.state.vel = (0, 0, -packing['fall_mps'])
    settle(packing['settle_s'])


def erase(gone):
    for body in [b.id for b in O.bodies if isinstance(b.shape, Sphere) and gone(b.state.pos)]:
        O.bodies.erase(body)


def level():  # as LIGGGHTS' region that cuts: a slope turns about x = .09
    slope = math.radians(value('SLOPE_DEG'))
    erase(lambda at: (at[2] - top) * math.cos(slope) - (at[0] - .09) * math.sin(slope) > -radius)
    rock = value('ROCK_M')
    if rock:
        centre = Vector3(.1138, 0, top)
        erase(lambda at: (at - centre).norm() < rock + radius)
        O.bodies.append(sphere(centre, rock, fixed=True, material='gravel'))
    O.engines[-1].damping = .4
    settle(packing['relax_s'])


def make_bed():
    pour()
    level()
    grains = [b for b in O.bodies if isinstance(b.shape, Sphere) and b.dynamic]
    weight = sum(b.state.mass for b in grains) * scene['gravity_mps2']
    floor = -sum((i.phys.normalForce + i.phys.shearForce)[2] * (1 if i.id1 in wall_ids else -1)
                 for w in wall_ids for i in O.bodies[w].intrs() if i.isReal)
    speed = math.sqrt(sum(b.state.vel.squaredNorm() for b in grains) / len(grains))
    print('bed: %d grains of %.4f N; its walls carry %.4f N; rms speed %.3g m/s' % (len(grains), weight, -floor, speed))
    with open(bed_file, 'w') as out:
        for b in O.bodies:
            if isinstance(b.shape, Sphere):
                out.write('%.9g %.9g %.9g %.9g\n' % (*b.state.pos, b.shape.radius if b.dynamic else -b.shape.radius))


def read_bed():
    for line in open(bed_file):
        x, y, z, r = map(float, line.split())
        O.bodies.append(sphere((x, y, z), abs(r), fixed=r < 0, material='gravel'))


# ---- the bucket: four plates across the width, in halves as no body may be wider than half the period; two sides as fans ----
def bucket():
    half, profile = scene['bucket']['width_m'] / 2, [Vector3(x, 0, z) for x, z in scene['bucket']['profile_m']]
    across = lambda point, y: Vector3(point[0], y, point[2])
    triangles = []
    for a, b in zip(profile, profile[1:]):
        for left, right in (-half, 0), (0, half):
            corners = across(a, left), across(b, left), across(b, right), across(a, right)
            triangles += [(corners[0], corners[1], corners[2]), (corners[0], corners[2], corners[3])]
    for a, b in zip(profile[1:], profile[2:]):
        triangles += [tuple(across(p, y) for p in (profile[0], a, b)) for y in (-half, half)]
    return triangles


def placed(point, pin, theta):
    return Vector3(pin[0] + point[0] * math.cos(theta) - point[2] * math.sin(theta), point[1],
                   pin[1] + point[0] * math.sin(theta) + point[2] * math.cos(theta))


def pose_at(trajectory, t):  # pin x, z and attitude
    x, z = trajectory['start_pin_m']
    theta = trajectory['theta0_deg']
    for phase in trajectory['phases']:
        dt = min(t, phase['duration_s'])
        x, z, theta = x + phase['vx_mps'] * dt, z + phase['vz_mps'] * dt, theta + phase['omega_degps'] * dt
        t -= dt
    return x, z, theta


sums, windows = [], 0


def wrench(pin):  # of the soil on the bucket, at its contacts: YADE's torque of a facet is not about a point of ours
    force, moment = Vector3.Zero, Vector3.Zero
    for facet_id in bucket_ids:
        for i in O.bodies[facet_id].intrs():
            if not i.isReal:
                continue
            sign = -1 if i.id1 == facet_id else 1
            f = sign * (i.phys.normalForce + i.phys.shearForce)
            force += f
            moment += (i.geom.contactPoint - pin).cross(f) + sign * i.phys.moment_bending
            limit_rolling(i, steel or rolling)
    return (*force, *moment)


def read_bucket():
    global windows
    x, z, _ = pose_at(trajectory, O.time - start_s)
    sums.append(wrench(Vector3(x, 0, z)))
    if len(sums) * stride == steps:
        t = (windows + .5) * window_s
        means = (sum(column) / len(sums) for column in zip(*sums))
        recording.write('%.6f,%.6f,%.6f,%.4f,%.5g,%.5g,%.5g,%.5g,%.5g,%.5g\n' % (t, *pose_at(trajectory, t), *means))
        recording.flush()
        windows += 1
        sums.clear()


def check_bucket(body_frame):
    x, z, theta = pose_at(trajectory, O.time - start_s)
    worst = 0
    for facet_id, triangle in zip(bucket_ids, body_frame):
        b = O.bodies[facet_id]
        for vertex, point in zip(b.shape.vertices, triangle):
            worst = max(worst, (b.state.pos + b.state.ori * vertex - placed(point, (x, z), math.radians(theta))).norm())
    print('bucket: off its path by %.3g m at the end' % worst)


def dig():
    global trajectory, bucket_ids, start_s, recording
    trajectory = next(t for t in scene['trajectories'] if t['name'] == task)
    body_frame = bucket()
    x, z, theta = pose_at(trajectory, 0)
    settle(.05)  # contacts are not kept in the file of the bed
    bucket_ids = [O.bodies.append(facet([placed(p, (x, z), math.radians(theta)) for p in triangle], material='bucket'))
                  for triangle in body_frame]
    slide.ids = turn.ids = bucket_ids
    unfinished = '%s__%s.part' % (bed_file, task)
    recording = open(unfinished, 'w')
    recording.write('# YADE %s, %s: tests/data/yade/make.sh\n' % (config.version, os.path.basename(bed_file)))
    recording.write('t_s,pin_x_m,pin_z_m,theta_deg,Fx_N,Fy_N,Fz_N,Mx_Nm,My_Nm,Mz_Nm\n')
    start_s = O.time
    reader.dead = False
    for phase in trajectory['phases']:
        x, z, _ = pose_at(trajectory, O.time - start_s)
        turning = phase['omega_degps'] != 0
        slide.dead, turn.dead = turning, not turning
        turn.zeroPoint, turn.angularVelocity = (x, 0, z), math.radians(phase['omega_degps'])
        move = Vector3(phase['vx_mps'], 0, phase['vz_mps'])
        slide.velocity, slide.translationAxis = move.norm(), move.normalized() if move.norm() else (1, 0, 0)
        if not turning and not move.norm() or turning and move.norm():
            raise RuntimeError('a phase moves or turns')
        settle(phase['duration_s'])
    check_bucket(body_frame)
    recording.close()
    os.rename(unfinished, '%s__%s.csv' % (bed_file, task))


def check():  # what can be known beforehand, at the dig's own step
    def parted(first, second):
        O.bodies.clear()
        a, b = (O.bodies[O.bodies.append(sphere(at, radius, material='gravel'))] for at in ((0, 0, 1), (0, 0, 1 + 2 * radius)))
        a.state.vel, b.state.vel = (0, 0, first), (0, 0, second)
        O.run(200, True)
        return (b.state.vel - a.state.vel)[2] / (first - second)

    def rolled(slope):  # after half a second on a plate
        global bucket_ids
        O.bodies.clear()
        gravity = scene['gravity_mps2'] / math.sqrt(1 + slope**2)
        O.engines[-1].gravity = (gravity * slope, 0, -gravity)
        bucket_ids = [O.bodies.append(facet([(-1, -1, 0), (1, -1, 0), (0, 1, 0)], material='bucket'))]
        grain = O.bodies[O.bodies.append(sphere((.1, 0, radius), radius, material='gravel'))]
        O.run(stride, True)
        wrench(Vector3(0, 0, 0))  # sets the limit
        settle(.5)
        return grain.state.pos[0] - .1, wrench(Vector3(0, 0, 0)), grain.state.mass * scene['gravity_mps2']

    O.engines[-1].gravity = (0, 0, 0)
    print('two grains part at %.3f and %.3f of their speed' % (parted(.01, -.01), parted(.5, -.5)))
    _, load, weight = rolled(0)
    print('a grain on a plate .1 m ahead of the pin: Fz %.6f of its weight, My %.6f of .1 m' % (load[2] / weight, load[4] / weight / .1))
    for share in .95, 1.05:
        print('on a slope of %.2f times its rolling friction it rolls %.3g m' % (share, rolled(share * (steel or rolling))[0]))


from yade import config
import time
if periodic:
    O.periodic = True
    O.cell.setBox(2, y1 - y0, 2)
materials()
wall_ids = [] if task == 'check' else walls()
engines()
began = time.time()
if task == 'check':
    check()
elif task == 'bed':
    make_bed()
else:
    read_bed()
    dig()
print('%s: %d steps of %.4g s in %.0f s, YADE would allow %.3g s' % (task, O.iter, O.dt, time.time() - began, PWaveTimeStep()))
