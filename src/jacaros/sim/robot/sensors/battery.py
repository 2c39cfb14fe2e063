"""The battery of a robot, as its driver publishes it."""

from jacaros.ros.message import constant
from jacaros.sim.robot.on_graph import RobotOnGraph

_TICKS_PER_BATTERY = 20


class BatterySensor:
    """``/battery_state``: 1 Hz, and when the robot begins or ends to charge."""

    def __init__(self, at: RobotOnGraph) -> None:
        self._robot, self._at = at.robot, at
        self._publisher = at.publisher("/battery_state", "sensor_msgs/msg/BatteryState")
        self._charging: tuple[bool, bool] | None = None

    def publish(self, ticks: int) -> None:
        """Publish if due."""
        charging = (self._robot.battery.charging, self._robot.fed)
        if ticks % _TICKS_PER_BATTERY == 0 or charging != self._charging:
            self._charging = charging
            self._send()

    def _send(self) -> None:
        battery = self._robot.battery
        message = self._publisher.message()
        self._at.fill_header(message.header, "base_footprint")
        message.voltage, message.percentage = battery.voltage, battery.level / 100.0
        message.current = message.charge = message.capacity = message.design_capacity = float("nan")
        message.present = True
        message.power_supply_status = constant(message, f"POWER_SUPPLY_STATUS_{self._status()}")
        self._publisher.publish(message)

    def _status(self) -> str:
        if self._robot.battery.charging:
            return "CHARGING"
        return "FULL" if self._robot.fed else "DISCHARGING"
