"""Writes turbines/mowito-06.toml: a stand-in for the tunnel turbine MoWiTO 0.6 from what is published of it.

    pip install neuralfoil==0.3.3 aerosandbox==4.2.10
    python validation/scripts/mowito_06.py > turbines/mowito-06.toml
    wakemix turbine steady turbines/mowito-06.toml --tsr 5 --pitch=-4:4:17

The last command shows the pitch of greatest power at tip-speed ratio 5 and its power coefficient: FINE_PITCH and
POWER_COEFFICIENT below. Put them in, and write the file again.
"""

import aerosandbox as asb
import numpy as np

# Fitted: by blade-element momentum theory at tip-speed ratio 5.
FINE_PITCH = 0.5
POWER_COEFFICIENT = 0.3871
# Published (van der Hoek et al. 2024): electrical power coefficient at tip-speed ratio 5, diameter, wind.
MEASURED, DIAMETER, WIND, RATIO = 0.27, 0.58, 5.0, 5.0
RADIUS, DENSITY = 0.5 * DIAMETER, 1.225
HUB_RADIUS = 0.0385
DESIGN_RATIO, DESIGN_LIFT, WIDEST = 6.0, 0.7, 0.05
REYNOLDS, N_CRIT = 4e4, 4.0
HUB_HEIGHT, OVERHANG = 1.425, 0.05
# Blades as solid carbon laminate.
MODULUS, MATERIAL, THICKNESS = 70e9, 1600.0, 0.0851
RATED_WIND = 8.0

FOIL = asb.Airfoil("sd7003")


def foil(angles):
    return FOIL.get_aero_from_neuralfoil(
        alpha=np.asarray(angles, float), Re=REYNOLDS, mach=0.0, n_crit=N_CRIT, model_size="xxxlarge",
        include_360_deg_effects=True)


def polar_rows():
    angles = np.unique(np.concatenate([
        np.arange(-180, 181, 5.0), np.arange(-30, 31, 2.0), np.arange(-12, 18.1, 0.5)]))
    found = foil(angles)
    rows = np.column_stack([angles, found["CL"], found["CD"], found["CM"]])
    rows[-1, 1:] = rows[0, 1:]
    return rows


def design_angle():
    angles = np.arange(0, 10, 0.05)
    return float(np.interp(DESIGN_LIFT, foil(angles)["CL"], angles))


def stations():
    # Optimum rotor with swirl (Schmitz): phi = 2/3 atan(R / (lambda r)).
    alpha = design_angle()
    rows = []
    for radius in np.concatenate([[HUB_RADIUS, 0.045, 0.055], np.linspace(0.065, RADIUS, 24)]):
        phi = 2.0 / 3.0 * np.arctan(RADIUS / (DESIGN_RATIO * max(radius, 0.065)))
        chord = 16 * np.pi * max(radius, 0.065) / (3 * DESIGN_LIFT) * np.sin(0.5 * phi) ** 2
        chord = min(chord, WIDEST)
        name = "SD7003"
        if radius < 0.06:
            name, share = "root", (radius - HUB_RADIUS) / (0.065 - HUB_RADIUS)
            chord = 0.012 + share * (chord - 0.012)
        rows.append((radius - HUB_RADIUS, chord, np.degrees(phi) - alpha, name))
    return rows


def cantilever(n):
    """Coefficients of x^2 to x^6 of the n-th mode of an even cantilever."""
    k = [1.8751041, 4.6940911][n - 1]
    x = np.linspace(0, 1, 200)
    sigma = (np.cosh(k) + np.cos(k)) / (np.sinh(k) + np.sin(k))
    shape = np.cosh(k * x) - np.cos(k * x) - sigma * (np.sinh(k * x) - np.sin(k * x))
    shape /= shape[-1]
    powers = np.column_stack([x**p for p in range(2, 7)])
    fit = np.linalg.lstsq(powers, shape, rcond=None)[0]
    return (fit / fit.sum()).round(4)


def mode(n, damping):
    values = [float(value) for value in cantilever(n)]
    values[-1] = round(1.0 - sum(values[:-1]), 4)
    return f"{{ coefficients = {values}, damping_ratio = {damping} }}"


def number(value):
    """Six significant digits, as TOML reads them as a number with a point."""
    text = f"{value:.6g}" if abs(value) >= 1e-4 or value == 0 else f"{value:.5e}"
    return text if "." in text or "e" in text else text + ".0"


def table(rows, show=number):
    cells = [[f'"{cell}"' if isinstance(cell, str) else show(cell) for cell in row] for row in rows]
    widths = [max(len(row[column]) for row in cells) for column in range(len(cells[0]))]
    lines = [", ".join(cell.rjust(width) for cell, width in zip(row, widths)) for row in cells]
    return "\n".join(f"  [ {line} ]," for line in lines)


def coefficient(value):
    text = f"{value:.5f}"
    return "0.00000" if text == "-0.00000" else text


blade = stations()
length = RADIUS - HUB_RADIUS
sections = []
for span, chord, twist, name in blade:
    thick = max(THICKNESS * chord, 0.003)
    area = np.pi / 4 * chord**2 if name == "root" and span == 0 else 0.68 * thick * chord
    sections.append((span, twist, MATERIAL * area, MODULUS * 0.037 * chord * thick**3, MODULUS * 0.037 * thick * chord**3))
spans = np.array([row[0] for row in sections])
masses = np.array([row[2] for row in sections])
speed = RATIO * WIND / RADIUS
area = np.pi * RADIUS**2
gain = 0.5 * DENSITY * area * RADIUS**3 * POWER_COEFFICIENT / RATIO**3
efficiency = MEASURED / POWER_COEFFICIENT
rated_speed = RATIO * RATED_WIND / RADIUS
rated_torque = gain * rated_speed**2
inertia = 3 * np.trapezoid(masses * (HUB_RADIUS + spans) ** 2, spans) + 8e-5 + 1.1e-5
corner = 10.0
tunnel = "van der Hoek, van den Abbeele, Simao Ferreira, van Wingerden, Wind Energy (2024), doi:10.1002/we.2896"
lever = np.sin(np.radians(2.25))
print(f'''# MoWiTO 0.6 tunnel turbine with a swashplate: a stand-in
# SI units unless the key says otherwise. Every group names its source.
# Positive precone, tilt, overhang and prebend carry the blade tips away from the tower;
# twist and pitch are positive to feather; heights count from ground or mean sea level.

name = "mowito-06"
title = "MoWiTO 0.6 tunnel turbine with a swashplate: a stand-in"
n_blades = 3

[rotor]
source = "Diameter 0.58 m: {tunnel}. Estimated: hub radius, overhang. Chosen: hub in the middle of an open jet of 2.85 m"
hub_radius = {HUB_RADIUS}  # rotor apex to blade root
tip_radius = {RADIUS}  # rotor apex to blade tip, along the pitch axis
precone_deg = 0.0
shaft_tilt_deg = 0.0
overhang = {OVERHANG}  # yaw axis to rotor apex, along the shaft
hub_height = {HUB_HEIGHT}  # rotor apex

[blade]
source = "Neither airfoil nor chord nor twist is in {tunnel}, and what it cites for the machine was not at hand. Assumed: airfoil SD7003, optimum rotor with swirl for tip-speed ratio {DESIGN_RATIO:g} and lift {DESIGN_LIFT:g}, no wider than {WIDEST} m; validation/scripts/mowito_06.py"
stations = [
  # span, chord, twist_deg, prebend, sweep, polar
{table([(s, c, t, 0.0, 0.0, n) for s, c, t, n in blade])}
]

[blade_structure]
source = "Estimated: solid carbon laminate, {MODULUS:.0e} Pa and {MATERIAL:g} kg/m3, modes of an even cantilever; nothing is published. Cases take structure = \\"rigid\\""
flap_mode_1 = {mode(1, 0.01)}
flap_mode_2 = {mode(2, 0.01)}
edge_mode_1 = {mode(1, 0.01)}
sections = [
  # span, twist_deg, mass, flap_stiffness, edge_stiffness
{table(sections)}
]

[tower]
source = "Estimated: a steel tube of 25 mm, half a metre long, from the platform to the nacelle in the middle of the jet; nothing is published"
base_height = 0.925  # clamped here
top_height = 1.4  # yaw bearing
top_to_shaft = 0.025  # yaw bearing up to the shaft, on the yaw axis
profile = [
  # height, diameter, drag
  [ 0.925, 0.025, 1.0 ],
  [ 1.4, 0.025, 1.0 ],
]
sections = [
  # height, mass, fore_aft_stiffness, side_to_side_stiffness
  [ 0.925, 1.13, 2150.0, 2150.0 ],
  [ 1.4, 1.13, 2150.0, 2150.0 ],
]
fore_aft_mode_1 = {mode(1, 0.01)}
fore_aft_mode_2 = {mode(2, 0.01)}
side_to_side_mode_1 = {mode(1, 0.01)}
side_to_side_mode_2 = {mode(2, 0.01)}

[hub]
source = "Estimated; nothing is published"
mass = 0.2
inertia = 8e-05  # about the shaft

[nacelle]
source = "Estimated; nothing is published"
mass = 1.0
yaw_inertia = 0.005  # about the yaw axis
center_of_mass = [0.05, 0.0, 0.025]  # from the tower top: downwind, left looking downwind, up
yaw_bearing_mass = 0.0

[drive_train]
source = "Fitted: efficiency, bearings included, so that electrical power is {MEASURED} of the wind's at tip-speed ratio 5 ({tunnel}) where blade-element momentum theory gives {POWER_COEFFICIENT} at the shaft. Assumed: generator on the rotor's shaft, inertia of a small DC motor, stiffness of the shaft"
gear_ratio = 1.0  # generator speed over rotor speed
generator_inertia = 1.1e-05  # about the generator's own shaft
gearbox_efficiency = 1.0
generator_efficiency = {efficiency:.4f}
stiffness = 50.0  # torsion, low-speed side
damping = 0.002  # torsion, low-speed side

[pitch_actuator]
source = "{tunnel}, par. 2.2: three stepper motors; 216 deg to and fro at 2.41 Hz, 41 deg/s of pitch here, was the most that they followed. Estimated: lag, limits"
natural_frequency = 200.0  # rad/s
damping_ratio = 0.8
maximum_rate_deg_s = 42.0
minimum_pitch_deg = -10.0
maximum_pitch_deg = 20.0

# Lag, rate and limits of its motors are those above, in collective pitch.
[pitch_actuator.swashplate]
source = "{tunnel}, par. 2.2, Table 1: motors to and fro by 180 deg pitch the blades by 2.5 deg on average where the plate goes round with the rotor (cw) and by 2.0 deg where it goes against it (ccw), 216 deg by 2.4 deg (ccw); a small bias of yaw. Straight in between, 180 deg are 2.25 deg. Estimated: lengths, of which only that ratio counts; slack; size of the bias, which is shown in a figure (Fig. 3) and in no number"
travel_per_turn = 0.001  # of a rod, by a nut on a threaded shaft
rod_radius = 0.015  # shaft to rods
link_radius = 0.015  # shaft to pitch links
horn_length = {0.0005 / lever:.7f}  # pitch axis of a blade to its link
rod_azimuth_deg = 0.0  # of the first rod
bias_deg = [0.0, 0.3]  # tilt and yaw pitch with the plate straight
slack_deg = 3.0  # play of the plate about the shaft, either way
gain_with_rotor = {2.5 / 2.25:.6f}  # tilt of the plate over that of the rods
gain_against_rotor = {2.0 / 2.25:.6f}  # its direction going round so

# [operation] is not in the source: with it, cases are held against cut-in and cut-out;
# source, cut_in_wind_speed and cut_out_wind_speed, mean wind at hub height (m/s)

[controller]
source = "Tip-speed ratio: {tunnel}, par. 2.1. K of K omega^2 by blade-element momentum theory. Fitted: fine pitch, that of the greatest power at tip-speed ratio 5; the paper's 10 deg count from a stop of the bearing. Estimated: gains for a speed loop of {corner:g} rad/s on the inertia above; what is above {RATED_WIND:g} m/s, where nobody measured"
# Low-speed side; gains act on measured minus reference rotor speed (rad/s).
rated_power_kw = {1e-3 * efficiency * rated_torque * rated_speed:.7f}  # electrical
rated_rotor_speed_rpm = {rated_speed * 30 / np.pi:.3f}
minimum_rotor_speed_rpm = 200.0
optimal_tip_speed_ratio = {RATIO}
torque_gain = {gain:.6e}  # torque over rotor speed squared below rated, N m s^2
rated_torque = {rated_torque:.6f}
minimum_torque = 0.0
maximum_torque = {1.2 * rated_torque:.6f}
maximum_torque_rate = 10.0  # N m/s
constant_power = true  # above rated
torque_proportional = {1.6 * corner * inertia:.6f}  # N m s
torque_integral = {corner**2 * inertia:.6f}  # N m
fine_pitch_deg = {FINE_PITCH}
maximum_pitch_deg = 20.0
maximum_pitch_rate_deg_s = 42.0
speed_filter_corner = 100.0  # rad/s
torque_control = "k-omega-squared"
set_point_smoothing = {{ torque_shift = 1.9, pitch_shift = 0.05, filter_corner = 30.0 }}
minimum_pitch = [
]
pitch_gains = [
  # pitch_deg   proportional_s   integral
  [ 0.0, 0.01, 0.03 ],
]

[airfoils]
source = "Assumed: SD7003, coordinates as aerosandbox 4.2.10 has them; the turbine's own airfoil is not in the source. Computed by NeuralFoil 0.3.3, which stands in for XFOIL, for Reynolds number {REYNOLDS:.0e}, the blades' in 5 m/s, n_crit {N_CRIT:g}, with its extension to the full circle, and held against no measurement; validation/scripts/mowito_06.py. Root: a cylinder, drag assumed"

[[airfoils.polar]]
name = "root"
table = [
  # angle_deg, lift, drag, moment
{table([(a, 0.0, 1.1, 0.0) for a in range(-180, 181, 10)], coefficient)}
]

[[airfoils.polar]]
name = "SD7003"
reynolds_number = {REYNOLDS}
table = [
  # angle_deg, lift, drag, moment
{table(polar_rows().tolist(), coefficient)}
]''')
