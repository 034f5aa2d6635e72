"""Spectra of sinusoids, which give back amplitude, frequency and order."""

import numpy as np
import pytest
import xarray as xr

from beltdyn.errors import ModelError
from beltdyn.results import Run
from beltdyn.results.derived import (
    amplitude_spectrum,
    element_order,
    order_spectrum,
    orders,
    overall_level,
    waterfall,
)
from beltdyn.results.schema import PASS_BAND

Signals = tuple[xr.DataArray, xr.DataArray, xr.DataArray]
TENSION = {"units": "N", "long_name": "Span tension"}
WINDOW_LOSS = {"hann": 0.16, "flattop": 0.002}
"""Largest part of an amplitude that is lost half-way between two frequencies (Heinzel, Rüdiger and Schilling 2002)."""


def series(time: np.ndarray, values: np.ndarray) -> xr.DataArray:
    return xr.DataArray(values, {"time": time}, ("time", *["span"] * (values.ndim - 1)), attrs=TENSION)


def test_a_sinusoid_gives_its_amplitude_at_its_frequency() -> None:
    """40 turns in 2 s, on a mean that does not count; exact, since both are those of the transform."""
    time = np.arange(2000) / 1000.0
    values = np.stack(
        [500.0 + 3.0 * np.cos(2.0 * np.pi * 20.0 * time), 7.0 * np.sin(2.0 * np.pi * 100.0 * time)], axis=1
    )
    spectrum = amplitude_spectrum(series(time, values))
    assert spectrum.dims == ("frequency", "span")
    assert float(spectrum.sel(frequency=20.0)[0]) == pytest.approx(3.0)
    assert float(spectrum.sel(frequency=100.0)[1]) == pytest.approx(7.0)
    assert spectrum.argmax("frequency").values.tolist() == [40, 200]
    assert (spectrum.attrs["units"], spectrum["frequency"].attrs["units"]) == ("N", "Hz")


@pytest.mark.parametrize("window", ["hann", "flattop"])
def test_between_two_frequencies_a_window_loses_what_is_known(window: str) -> None:
    time = np.arange(2000) / 1000.0
    spectrum = amplitude_spectrum(series(time, 3.0 * np.cos(2.0 * np.pi * 20.25 * time)), window)
    assert 3.0 * (1.0 - WINDOW_LOSS[window]) < float(spectrum.max()) < 3.01


def test_uneven_outputs_are_laid_out_evenly() -> None:
    """Also where the ends are unknown, as those of filtered variables may be."""
    time = np.delete(np.arange(2000) / 1000.0, [500, 901])
    values = 3.0 * np.cos(2.0 * np.pi * 20.0 * time)
    values[[0, -1]] = np.nan
    spectrum = amplitude_spectrum(series(time, values))
    assert float(spectrum.max()) == pytest.approx(3.0, rel=0.01)


def test_no_spectrum_over_a_time_in_which_the_belt_was_lost() -> None:
    time = np.arange(2000) / 1000.0
    values = 3.0 * np.cos(2.0 * np.pi * 20.0 * time)
    values[1000:1100] = np.nan
    with pytest.raises(ModelError, match=r"Span tension is unknown from t = 1 s to 1.099 s, .* Select a time before"):
        amplitude_spectrum(series(time, values))
    assert float(amplitude_spectrum(series(time, values)[:1000]).max()) == pytest.approx(3.0)


@pytest.mark.parametrize("outputs", [0, 1, 10, 15])
def test_too_few_outputs_have_no_spectrum(outputs: int) -> None:
    """A variable that is recorded for spectra has none at all in a run of up to 24 outputs."""
    few, pulley = (series(np.arange(1.0 * count), np.ones(count)) for count in (outputs, max(outputs, 1)))
    for spectrum in (
        amplitude_spectrum,
        lambda values: waterfall(values, pulley),
        lambda values: orders(values, pulley),
    ):
        with pytest.raises(ModelError, match=f"{outputs} outputs are too few for a spectrum; 16 or more"):
            spectrum(few)


def test_sixteen_outputs_are_enough_for_a_spectrum() -> None:
    """Of four waves: their amplitude stands at a quarter of the sampling rate."""
    time = np.arange(16) / 16.0
    assert float(amplitude_spectrum(series(time, np.cos(8.0 * np.pi * time))).sel(frequency=4.0)) == pytest.approx(1.0)


@pytest.mark.parametrize(("outputs", "spectra"), [(16, 1), (19, 1), (20, 2), (24, 3)])
def test_a_run_up_is_two_spectra_or_more(outputs: int, spectra: int) -> None:
    """The shortest are of 16 outputs, one every four; with one there is no telling how the amplitude changes."""
    time = np.arange(1.0 * outputs)
    record, speed = series(time, np.cos(0.5 * np.pi * time)), series(time, 10.0 + time)
    if spectra > 1:
        np.testing.assert_allclose(waterfall(record, speed)["speed"], 18.0 + 4.0 * np.arange(spectra), rtol=1e-12)
    else:
        with pytest.raises(ModelError, match="there is no run-up"):
            waterfall(record, speed)


@pytest.fixture
def run_up() -> Signals:
    """Order 2.5 with an amplitude that grows with the speed, and a hum of 90 Hz, from 20 to 220 rad/s in 8 s."""
    time = np.arange(0.0, 8.0, 5e-4)
    speed, angle = 20.0 + 25.0 * time, 20.0 * time + 12.5 * time**2
    values = 100.0 + 0.05 * speed * np.cos(2.5 * angle) + 2.0 * np.cos(2.0 * np.pi * 90.0 * time)
    label = {"units": "rad/s", "long_name": "Pulley speed"}
    return series(time, values), xr.DataArray(speed, {"time": time}, ("time",), attrs=label), series(time, angle)


def test_waterfall_shows_the_line_of_an_order_and_that_of_a_hum(
    run_up: Signals,
) -> None:
    """Lines of an order that sweeps spread over the change of frequency within a piece; the hum does not."""
    values, speed, _ = run_up
    found = waterfall(values, speed)
    width = float(found["frequency"][1])
    assert float(found["speed"][0]) > 20.0
    assert np.all(np.diff(found["speed"]) > 0.0)
    hum = found.sel(frequency=90.0, method="nearest")
    np.testing.assert_allclose(hum[found["speed"] < 150.0], 2.0, rtol=0.25)
    low = found.where(found["frequency"] < 80.0, drop=True)
    ridge = low["frequency"][low.argmax("frequency").values]
    slow = (found["speed"].values > 80.0) & (found["speed"].values < 180.0)
    np.testing.assert_allclose(ridge.values[slow], 2.5 * found["speed"].values[slow] / (2.0 * np.pi), atol=width)


def test_a_single_spectrum_longer_than_the_record_is_no_run_up(run_up: Signals) -> None:
    """With three pieces each is to be of four thirds of the record."""
    values, speed, _ = run_up
    with pytest.raises(ModelError, match="there is no run-up"):
        waterfall(values, speed, pieces=3)


def test_speeds_of_a_waterfall_are_those_in_the_middle_of_its_spectra(run_up: Signals) -> None:
    """Spectra of 1064 outputs, every 266 of them, that lie wholly inside."""
    values, speed, _ = run_up
    middle = 0.5 * 1064 + 266.0 * np.arange((16000 - 1064) // 266 + 1)
    np.testing.assert_allclose(waterfall(values, speed)["speed"], 20.0 + 25.0 * middle * 5e-4, rtol=1e-9)


def test_a_waterfall_shows_speeds_that_are_higher_than_all_before(run_up: Signals) -> None:
    """A speed that dips at the beginning and holds for a second: the spectra of neither count twice."""
    values, speed, _ = run_up
    time = speed["time"].values
    wavering = speed.copy(data=np.where(time < 4.0, np.abs(40.0 * time - 20.0), np.maximum(140.0, 20.0 * time + 40.0)))
    found = waterfall(values, wavering)
    assert np.all(np.diff(found["speed"]) > 1e-9)
    assert found.sizes["speed"] < waterfall(values, speed).sizes["speed"]
    highest = 0.5 * 1064 * 5e-4 * 20.0
    assert float(found["speed"][-1]) == pytest.approx(200.0 - highest, abs=266 * 5e-4 * 20.0)


def test_a_run_up_may_be_small_but_not_a_ripple(run_up: Signals) -> None:
    """A hundredth of the speed is the least, so that what a drive's speed swings by is none."""
    values, _, _ = run_up
    time = values["time"].values
    slow = series(time, 100.0 + time / 8.0 * 1.8)
    assert np.all(np.diff(waterfall(values, slow)["speed"]) > 0.0)
    for speed in (100.0 + 0.1 * time, 100.0 + 0.3 * np.sin(2.0 * np.pi * 0.3 * time)):
        with pytest.raises(ModelError, match=r"the speed is constant at 100(\.\d)? rad/s: there is no run-up"):
            waterfall(values, series(time, speed))


def test_one_unknown_output_takes_the_spectra_that_hold_it(run_up: Signals) -> None:
    values, speed, _ = run_up
    lost = values.copy()
    lost[100] = np.nan
    unknown = np.isnan(waterfall(lost, speed).values).all(axis=1)
    assert unknown.tolist() == [True] + [False] * (len(unknown) - 1)


LOST = slice(8000, 8200)
"""Outputs of the run-up without a value, 0.1 s from 4 s on."""


def test_waterfall_and_orders_have_a_gap_where_the_belt_was_lost(
    run_up: tuple[xr.DataArray, xr.DataArray, xr.DataArray],
) -> None:
    """Every spectrum that knows all of its time is as before, and every other has no value at all."""
    values, speed, angle = run_up
    lost = values.copy()
    lost[LOST] = np.nan
    for kind, along, longest in ((waterfall, speed, 0.55), (orders, angle, 8.0 * 2.0 * np.pi / 120.0)):
        whole, found = kind(values, along), kind(lost, along)
        np.testing.assert_array_equal(found["speed"], whole["speed"])
        unknown = np.isnan(found.values).all(axis=1)
        np.testing.assert_allclose(found[~unknown], whole[~unknown], atol=1e-9)
        gap = (found["speed"].values[unknown] - 20.0) / 25.0  # middles of the spectra, s
        assert 4.0 - 0.5 * longest < gap.min() < 4.0
        assert 4.1 < gap.max() < 4.1 + 0.5 * longest


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_orders_follow_the_rotation_either_way(run_up: Signals, way: float) -> None:
    """The amplitude within 3 %: it changes by that within eight revolutions at the lowest speed that is shown."""
    values, _, angle = run_up
    found = orders(values, way * angle + 500.0)
    at = found.sel(order=2.5)
    away = np.abs(2.0 * np.pi * 90.0 / found["speed"] - 2.5) > 0.5
    np.testing.assert_allclose(at[away], 0.05 * found["speed"][away], rtol=0.03)
    assert float(found["speed"].min()) >= 20.0
    assert float(found["order"].max()) <= 20.0
    quiet = found.sel(order=slice(3.5, 4.0))[found["speed"] < 120.0]
    assert float(quiet.max()) < 0.1


def test_a_run_down_has_the_same_orders(run_up: Signals) -> None:
    values, _, angle = run_up
    back = orders(
        values.copy(data=values.values[::-1]), angle.copy(data=float(angle[-1]) - angle.values[::-1]), largest=10.0
    )
    assert np.all(np.diff(back["speed"]) > 0.0)
    assert back.sizes["speed"] == orders(values, angle).sizes["speed"]
    assert float(back["order"][1:].values[int(np.argmax(back.mean("speed").values[1:]))]) == pytest.approx(2.5)


def test_variables_without_unit_and_name_have_spectra_and_orders(run_up: Signals) -> None:
    """As those that a user computes, which lose their attributes."""
    values, angle = run_up[0].drop_attrs(), run_up[2]
    for found in (orders(values, angle), amplitude_spectrum(values)):
        assert found.attrs == {"units": "1", "long_name": "Amplitude of the variable"}
    assert orders(values.rename("swing"), angle).attrs["long_name"] == "Amplitude of swing"
    assert np.array_equal(orders(values, angle), orders(run_up[0], angle), equal_nan=True)


def test_orders_need_turns() -> None:
    time = np.arange(0.0, 1.0, 1e-3)
    with pytest.raises(ModelError, match=r"makes 3.18 turns .* orders need 16 or more"):
        orders(series(time, time), series(time, 20.0 * time))


def test_a_constant_speed_is_no_run_up() -> None:
    time = np.arange(0.0, 1.0, 1e-3)
    speed = xr.DataArray(
        np.full(1000, 300.0), {"time": time}, ("time",), attrs={"units": "rad/s", "long_name": "Speed"}
    )
    with pytest.raises(ModelError, match="the speed is constant at 300 rad/s"):
        waterfall(series(time, np.sin(time)), speed)


def after(values: xr.DataArray, delay: float) -> xr.DataArray:
    """The same, recorded later."""
    return values.assign_coords(time=values["time"] + delay)


def test_it_does_not_matter_when_a_record_begins(run_up: Signals) -> None:
    values, speed, angle = run_up
    for now, later in (
        (amplitude_spectrum(values), amplitude_spectrum(after(values, 64.0))),
        (waterfall(values, speed), waterfall(after(values, 64.0), after(speed, 64.0))),
        (orders(values, angle), orders(after(values, 64.0), after(angle, 64.0) + 500.0)),
    ):
        xr.testing.assert_allclose(now, later, rtol=1e-6, atol=1e-6)  # 64 s + 0.5 ms is rounded to 1e-14 s


def test_frequencies_end_at_half_of_the_sampling_rate(run_up: Signals) -> None:
    """Of 2000 Hz (Nyquist); the spectra of a piece of 1064 outputs are 2000 / 1064 Hz apart."""
    values, speed, _ = run_up
    frequency = waterfall(values, speed)["frequency"].values
    assert frequency[-1] == pytest.approx(1000.0, rel=1e-12)
    np.testing.assert_allclose(np.diff(frequency), 2000.0 / 1064, rtol=1e-9)
    assert amplitude_spectrum(values)["frequency"].values[-1] == pytest.approx(1000.0, rel=1e-12)


def test_coordinates_of_what_is_no_time_are_kept() -> None:
    time = np.arange(100) / 100.0
    values = series(time, np.outer(np.sin(time), [1.0, 2.0])).assign_coords(span=["tight", "slack"])
    assert amplitude_spectrum(values)["span"].values.tolist() == ["tight", "slack"]


def test_speeds_are_those_of_the_revolution_in_the_middle_of_a_spectrum(run_up: Signals) -> None:
    """At constant acceleration the speed is sqrt(w_0^2 + 2 a phi); spectra of 8 revolutions begin every two of them, at
    22 rad/s, a tenth of the largest speed.
    """
    values, _, angle = run_up
    found = orders(values, angle)["speed"].values
    middle = 2.0 * np.pi * (4.0 + 2.0 * np.arange(len(found)))
    before, behind = (np.sqrt(22.0**2 + 2.0 * 25.0 * (middle + side)) for side in (-np.pi, np.pi))
    np.testing.assert_allclose(found, 0.5 * (before + behind), rtol=3e-4)  # it begins within an output, 0.011 rad


def test_speeds_of_orders_are_means_over_a_revolution() -> None:
    """Of constant acceleration from a speed that counts from the first output on: w^2 = w_0^2 + 2 a phi."""
    time = np.arange(0.0, 8.0, 5e-4)
    angle = 30.0 * time + 12.5 * time**2
    found = orders(series(time, np.cos(2.0 * angle)), series(time, angle))
    middle = 2.0 * np.pi * (4.0 + 2.0 * np.arange(found.sizes["speed"]))
    before, behind = (np.sqrt(30.0**2 + 2.0 * 25.0 * (middle + side)) for side in (-np.pi, np.pi))
    np.testing.assert_allclose(found["speed"], 0.5 * (before + behind), rtol=1e-6)  # straight between outputs


def test_a_stop_after_a_run_up_does_not_count(run_up: Signals) -> None:
    values, _, angle = run_up
    rest = np.arange(8.0, 10.0, 5e-4)
    whole = series(np.append(values["time"], rest), np.append(values.values, np.full(rest.size, 100.0)))
    turned = series(np.append(angle["time"], rest), np.append(angle.values, np.full(rest.size, float(angle[-1]))))
    found, expected = orders(whole, turned), orders(values, angle)
    np.testing.assert_allclose(found["speed"], expected["speed"], rtol=1e-6)
    np.testing.assert_allclose(found.sel(order=2.5), expected.sel(order=2.5), rtol=1e-3)


@pytest.mark.parametrize(("turns", "enough"), [(16.0 + 1e-6, True), (16.0 - 1e-6, False)])
def test_orders_need_twice_the_turns_of_a_spectrum(turns: float, enough: bool) -> None:
    time = np.linspace(0.0, 2.0, 2001)
    angle = 2.0 * np.pi * turns * (time + time**2) / 6.0
    if enough:
        assert orders(series(time, np.cos(angle)), series(time, angle)).sizes["speed"] > 1
    else:
        with pytest.raises(ModelError, match="orders need 16 or more"):
            orders(series(time, np.cos(angle)), series(time, angle))


def test_slow_turning_before_a_run_up_does_not_count(run_up: Signals) -> None:
    """Ten turns at 15 rad/s, below a tenth of the largest speed, for four seconds."""
    values, _, angle = run_up
    idle = np.arange(-4.0, 0.0, 5e-4)
    whole = series(np.append(idle, values["time"]), np.append(100.0 + np.cos(2.0 * np.pi * 90.0 * idle), values.values))
    turned = series(np.append(idle, values["time"]), np.append(15.0 * idle, angle.values))
    xr.testing.assert_allclose(orders(whole, turned), orders(values, angle), rtol=1e-6, atol=1e-6)
    short = turned["time"] < 0.2
    with pytest.raises(ModelError, match=r"makes 7\.\d* turns above a tenth"):  # of 250 rad/s
        orders(whole[short], turned[short].where(turned[short] < 0.0, 10.0 * turned[short]))


def test_sixteen_turns_are_enough_for_spectra_of_eight() -> None:
    time = np.arange(0.0, 2.0, 1e-3)
    angle = 2.0 * np.pi * (4.0 * time + 2.2 * time**2)  # 16.8 turns
    found = orders(series(time, np.cos(3.0 * angle)), series(time, angle))
    assert float(found.sel(order=3.0).min()) == pytest.approx(1.0, rel=0.01)


@pytest.mark.parametrize(("order", "acceleration"), [(45.0, 15.0), (150.0, 5.0)])
def test_a_high_order_is_not_folded_onto_a_low_one(order: float, acceleration: float) -> None:
    """Far above the largest that is asked for, and slower than 1600 Hz; there are 5000 outputs a second."""
    time = np.arange(0.0, 8.0, 2e-4)
    angle = 20.0 * time + 0.5 * acceleration * time**2
    wave = series(time, 5.0 * np.cos(order * angle))
    assert float(orders(wave, series(time, angle)).max()) < 0.01


def test_the_largest_order_is_reached_however_coarse_the_record_is() -> None:
    time = np.arange(0.0, 8.0, 2e-2)
    angle = 20.0 * time + 1.25 * time**2  # to 40 rad/s: 8 outputs in a revolution
    found = orders(series(time, np.cos(angle)), series(time, angle))
    assert float(found["order"].max()) == 20.0
    assert float(found.sel(order=1.0).min()) == pytest.approx(1.0, rel=0.02)


def test_nothing_is_said_beyond_the_pass_band_of_what_was_filtered(run_up: Signals) -> None:
    """Frequencies end there, and orders are unknown where they are higher; what was not filtered is known up to its
    ends.
    """
    values, speed, angle = run_up
    filtered = values.rename(time="filtered_time")
    highest = PASS_BAND * 2000.0
    for spectrum in (amplitude_spectrum(filtered), waterfall(filtered, speed)):
        frequency = spectrum["frequency"].values
        assert highest - (frequency[1] - frequency[0]) < frequency[-1] <= highest
    largest = 60.0
    free, bounded = (orders(wanted, angle, largest) for wanted in (values, filtered))
    assert np.isfinite(free).all()
    beyond = np.outer(bounded["speed"], bounded["order"]) / (2.0 * np.pi) > highest
    assert beyond.any()
    np.testing.assert_array_equal(np.isnan(bounded), beyond)
    np.testing.assert_array_equal(bounded.values[~beyond], free.values[~beyond])


def test_elements_pass_a_pulley_as_often_as_its_turn_is_longer(run: Run) -> None:
    """The arcs of both pulleys, half a turn each, make one turn: it takes the belt but for its two spans."""
    path = run.drive.path
    share = 1.0 - path.span_lengths.sum() / path.length
    for pulley in (0, 1):
        assert element_order(run.drive, pulley) == pytest.approx(run.drive.elements * share)
    still = run.drive.replace(simulation=run.drive.simulation.replace(frame="staying", start="equilibrium"))
    assert element_order(still, 0) == np.inf


def test_the_pass_band_belongs_to_the_rate_of_the_outputs() -> None:
    """400 of them at 50 Hz: 18.75 Hz, which one output more or less would shift by 0.05 Hz."""
    time = np.arange(0.0, 8.0, 2e-2)
    angle = 20.0 * time + 1.25 * time**2
    wave = series(time, np.cos(angle)).rename(time="filtered_time")
    found = orders(wave, series(time, angle))
    frequency = np.outer(found["speed"], found["order"]) / (2.0 * np.pi)
    np.testing.assert_array_equal(np.isfinite(found), frequency <= PASS_BAND * 50.0)
    close = np.abs(frequency - PASS_BAND * 50.0) < 0.05
    assert (close & np.isfinite(found.values)).any()
    assert (close & np.isnan(found.values)).any()


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_an_order_spectrum_depends_on_neither_sense_nor_beginning_of_a_rotation(way: float) -> None:
    """5.3 turns of an angle that is recorded from before on, of which five are taken: exact for whole orders."""
    time = np.arange(0.0, 3.0, 1e-3)
    turned = 2.0 * np.pi * (2.0 * time + 0.1 * time**2)
    angle = series(time, way * turned + 500.0)
    late = time > 0.7
    wave = series(time[late], 4.0 + 3.0 * np.cos(7.0 * turned[late]))
    found = order_spectrum(wave, angle, "boxcar")
    assert float(found["order"][1]) == pytest.approx(0.2)  # one over five turns
    assert float(found.sel(order=7.0, method="nearest")) == pytest.approx(3.0, rel=1e-3)
    assert float(found.where(np.abs(found["order"] - 7.0) > 0.1).max()) < 0.01


@pytest.mark.parametrize(("turns", "enough"), [(2.0, True), (2.0 - 1e-6, False), (3.0, True)])
def test_an_order_spectrum_needs_two_turns_and_takes_all_whole_ones(turns: float, enough: bool) -> None:
    """To rounding; as many outputs in a turn as were recorded: orders end at half of 400 over the turns."""
    time = np.linspace(0.0, 1.0, 401)
    angle = series(time, 2.0 * np.pi * turns * time + 0.1)
    if enough:
        order = order_spectrum(series(time, np.cos(5.0 * angle.values)), angle)["order"].values
        assert (order[1], order[-1]) == pytest.approx((1.0 / turns, 0.5 * np.ceil(400.0 / turns)), abs=0.5 / turns)
        assert order[1] == pytest.approx(1.0 / turns, rel=1e-9)
    else:
        with pytest.raises(ModelError, match="makes 2 turns without turning back; an order spectrum needs 2 or more"):
            order_spectrum(angle, angle)


def test_a_pulley_that_turns_back_has_no_order_spectrum() -> None:
    time = np.linspace(0.0, 1.0, 401)
    there_and_back = series(time, 40.0 * np.sin(3.0 * time))
    with pytest.raises(ModelError, match="without turning back"):
        order_spectrum(there_and_back, there_and_back)


def test_an_overall_level_is_that_of_all_its_waves() -> None:
    """Root mean square of two sinusoids, whatever the mean is: Parseval's theorem."""
    time = np.arange(0.0, 4.0, 1e-3)
    waves = 50.0 + 3.0 * np.cos(2.0 * np.pi * 40.0 * time) + 4.0 * np.sin(2.0 * np.pi * 110.0 * time)
    level = overall_level(waterfall(series(time, waves), series(time, 10.0 + time)))
    np.testing.assert_allclose(level, np.sqrt(0.5 * (9.0 + 16.0)), rtol=1e-3)
    assert level.attrs == {"units": "N", "long_name": "Overall level (RMS)"}
