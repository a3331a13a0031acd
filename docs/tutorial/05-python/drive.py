import ziggurat

RADIUS, GOAL = 0.03, 1  # of a wheel; how far to drive [m]

with ziggurat.connect() as session:
    robot = session.robots["vehicle"]
    for tick in session:
        if tick.event is ziggurat.Event.STEP:
            way = RADIUS * robot.joints["front_left"].encoder
            speed = min(0.3, 2 * (GOAL - way))  # [m/s]: slower near the goal
            for wheel in robot.joints:
                wheel.target = speed / RADIUS  # [rad/s]
            robot.log(f"{way:.3f} m")
