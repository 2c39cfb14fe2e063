"""Maps: the ground as cells, filled by agents or by a robot's sensors, and routes over them.

=================== ======================================================================================
file                content
=================== ======================================================================================
`slam_data`         ``ArtSlamData`` of the thesis: cells that agents label, range of view, routes
`robot_map`         ``ArtMap``: the same, filled from scans or ``/map``, with the robot on it
`posed_map`         the robot's pose on it, doubt about it, and the search for its place
`cells`             cells and their labels; an occupancy grid; a map as text
`mapper`            from scans and odometry to a grid and a pose, with `scan_matching`
`doubt`             how well scans match the map at the robot's pose
`place_search`      the places at which a lost robot can be, fewer with each scan
`routes`            routes for a robot with a size, and the border of unknown ground
`map_files`         foreign maps: files of map_server, ``nav_msgs/msg/OccupancyGrid``
=================== ======================================================================================
"""
