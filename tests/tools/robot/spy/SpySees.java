// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
import java.awt.Component;
import java.awt.Container;
import java.awt.Frame;
import javax.swing.JTable;

/// Starts lcm-spy in its own window and reads from its table what it makes of a channel.
/// usage: SpySees URL CHANNEL TYPE SECONDS; ends with 0 when the channel is there with that type,
/// a rate, and nothing undecodable.
public class SpySees {
  private static JTable tableIn(Component component) {
    if (component instanceof JTable) return (JTable) component;
    if (!(component instanceof Container)) return null;
    for (Component child : ((Container) component).getComponents()) {
      JTable table = tableIn(child);
      if (table != null) return table;
    }
    return null;
  }

  private static String cell(JTable table, int row, String column) {
    for (int i = 0; i < table.getColumnCount(); ++i)
      if (table.getColumnName(i).trim().equals(column)) return "" + table.getValueAt(row, i);
    return "no column " + column;
  }

  /// "CHANNEL type T rate R undecodable U" of a channel's row; null without one.
  private static String rowOf(String channel) {
    for (Frame frame : Frame.getFrames()) {
      JTable table = tableIn(frame);
      if (table == null) continue;
      for (int row = 0; row < table.getRowCount(); ++row)
        if (cell(table, row, "Channel").equals(channel))
          return channel + " type " + cell(table, row, "Type") + " rate " + cell(table, row, "Hz")
              + " undecodable " + cell(table, row, "Undecodable");
    }
    return null;
  }

  private static boolean fits(String row, String channel, String type) {
    if (row == null || !row.startsWith(channel + " type " + type + " rate ")) return false;
    if (!row.endsWith(" undecodable 0")) return false;
    return Double.parseDouble(row.split(" rate ")[1].trim().split(" ")[0].replace(',', '.')) > 1.0;
  }

  private static String look(String channel) throws Exception {
    String[] row = {null};
    javax.swing.SwingUtilities.invokeAndWait(() -> row[0] = rowOf(channel));
    return row[0];
  }

  public static void main(String[] arguments) throws Exception {
    String channel = arguments[1];
    // Throws if a library of the charts is missing.
    new info.monitorenter.gui.chart.Chart2D();
    lcm.spy.Spy.main(new String[] {"--lcm-url=" + arguments[0]});
    String row = null;
    for (int i = 0; i < 10 * Integer.parseInt(arguments[3]); ++i) {
      row = look(channel);
      if (fits(row, channel, arguments[2])) {
        System.out.println("seen: " + row);
        System.exit(0);
      }
      Thread.sleep(100);
    }
    System.out.println("not seen; the last row of " + channel + ": " + row);
    System.exit(1);
  }
}
