"""Maps: the ground as cells, filled by agents or by a robot's sensors, and routes over them.

================================ ======================================================================
file                             content
================================ ======================================================================
`slam_data`                      ``ArtSlamData`` of the thesis: cells that agents label, range of view,
                                 routes
`robot_map`                      ``ArtMap``: the same, filled from scans or ``/map``, with the robot on it
`cells`, `occupancy`             cells and their labels; an occupancy grid
`mapper`                         from scans and odometry to a grid and a pose, built from `scans`,
                                 `localisation` and `scan_matching`
`route`, `inflation`, `legs`     routes for a robot with a size
`frontiers`                      the border of unknown ground
`map_files`, `grids`             foreign maps: files of map_server, ``nav_msgs/msg/OccupancyGrid``
`picture`                        a map as text
================================ ======================================================================
"""
