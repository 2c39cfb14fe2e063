"""Maps: the ground as cells, filled by agents or by a robot's sensors, and ways over them.

================================ ======================================================================
file                             what it holds
================================ ======================================================================
`slam_data`                      ``ArtSlamData`` of the thesis: cells that agents label, range of view,
                                 routes
`robot_map`                      ``ArtMap``: the same, filled by scans or by ``/map``, with the robot on it
`cells`, `occupancy`             cells and their labels; an occupancy grid
`mapper`                         from scans and odometry to a grid and a pose, made of `scans`,
                                 `localisation`, `scan_matching` and `poses`
`route`, `inflation`, `legs`     ways for a robot that has a size
`frontiers`                      where there is unknown ground
`map_files`, `grids`             maps of others: files of map_server, ``nav_msgs/msg/OccupancyGrid``
`picture`                        a map as text
================================ ======================================================================
"""
