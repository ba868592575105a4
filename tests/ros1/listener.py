"""Writes down what goes by on the topics of a robot, as ROS's own client library reads it.

Each line is a topic and what was said on it: for /cmd_vel the speed ahead and the turn, for /scan the number
of ranges, for the others nothing more. A message of another type than the topic's is not read.
"""

import sys

import rospy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import CompressedImage, LaserScan

out = open(sys.argv[1], "w", buffering=1)
rospy.init_node("listener", anonymous=True, disable_signals=True)
rospy.Subscriber("/cmd_vel", Twist, lambda said: out.write(f"/cmd_vel {said.linear.x} {said.angular.z}\n"))
rospy.Subscriber("/odom", Odometry, lambda said: out.write("/odom\n"))
rospy.Subscriber("/camera/image/compressed", CompressedImage, lambda said: out.write("/camera\n"))
rospy.Subscriber("/scan", LaserScan, lambda said: out.write(f"/scan {len(said.ranges)}\n"))
out.write("listening\n")
rospy.spin()
